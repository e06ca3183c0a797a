// A free rigid body in Jolt itself, compiled to WebAssembly, in f32: node run_jolt.mjs FOLDER, beside an install of jolt-physics.
import init from 'jolt-physics/wasm-compat';
import fs from 'fs';
const J = await init();
const out = process.argv[2];
const h = 0.01, N = 1000;
const f = x => Math.fround(x);
const cases = { top:[[0,0,0],0,[0.1,2,0.1]], torque:[[0.3,0,0.2],0,[0.1,2,0.1]], damped:[[0,0,0],0.1,[0.1,2,0.1]], torquedamped:[[0.3,0,0.2],0.1,[0.1,2,0.1]], fast:[[0,0,0],0,[60,70,20]], slow:[[0,0,0],0,[1e-5,5e-5,2e-5]] };
const settings = new J.JoltSettings(); settings.mMaxWorkerThreads = 0;
const op = new J.ObjectLayerPairFilterTable(1); op.EnableCollision(0,0);
const bp = new J.BroadPhaseLayerInterfaceTable(1,1); bp.MapObjectToBroadPhaseLayer(0,new J.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = op; settings.mBroadPhaseLayerInterface = bp;
settings.mObjectVsBroadPhaseLayerFilter = new J.ObjectVsBroadPhaseLayerFilterTable(bp,1,op,1);
const jolt = new J.JoltInterface(settings); const ps = jolt.GetPhysicsSystem(); ps.SetGravity(new J.Vec3(0,0,0));
const bi = ps.GetBodyInterface();
for (const gyro of [true,false]) for (const [name,[tau,c,w0]] of Object.entries(cases)) {
  const shape = new J.SphereShape(0.5);
  const s = new J.BodyCreationSettings(shape,new J.RVec3(0,0,0),new J.Quat(0,0,0,1),J.EMotionType_Dynamic,0);
  s.mOverrideMassProperties = J.EOverrideMassProperties_MassAndInertiaProvided;
  const mp = s.mMassPropertiesOverride; mp.mMass = 1;
  const I = J.Mat44.prototype.sIdentity();  
  I.SetColumn3(0,new J.Vec3(1,0,0)); I.SetColumn3(1,new J.Vec3(0,2,0)); I.SetColumn3(2,new J.Vec3(0,0,3));
  mp.mInertia = I;
  s.mLinearDamping = 0; s.mAngularDamping = c; s.mAllowSleeping = false; s.mApplyGyroscopicForce = gyro;
  s.mMaxAngularVelocity = 1e4; s.mAngularVelocity = new J.Vec3(...w0);
  const b = bi.CreateBody(s); bi.AddBody(b.GetID(),J.EActivation_Activate);
  const mprop = b.GetMotionProperties(); const d = mprop.GetInverseInertiaDiagonal(), r = mprop.GetInertiaRotation();
  console.log(name,gyro,'inv diag',d.GetX(),d.GetY(),d.GetZ(),'inertia rot',r.GetX(),r.GetY(),r.GetZ(),r.GetW());
  const rows = ['t,qx,qy,qz,qw,wx,wy,wz'];
  const rec = k => { const q=b.GetRotation(), w=b.GetAngularVelocity(); rows.push([k*h,q.GetX(),q.GetY(),q.GetZ(),q.GetW(),w.GetX(),w.GetY(),w.GetZ()].map(x=>x.toPrecision(17)).join(',')); };
  rec(0);
  for (let k=1;k<=N;k++) { if (tau[0]) b.AddTorque(new J.Vec3(...tau)); jolt.Step(h,1); if (k<=3||k%100==0) rec(k); }
  fs.writeFileSync(`${out}/jolt_${gyro?'gyro':'default'}_${name}.csv`,rows.join('\n')+'\n');
  console.log(rows[2]); console.log(rows[rows.length-1]);
  bi.RemoveBody(b.GetID()); bi.DestroyBody(b.GetID());
}
process.exit(0);
