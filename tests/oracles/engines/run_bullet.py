"""Free rigid body in Bullet itself (pybullet). Writes FOLDER/bullet_<variant>_<case>.csv: t,qx,qy,qz,qw,wx,wy,wz (world omega).
variant rb: btRigidBody (useMaximalCoordinates=1), implicit body gyroscopic step by default. variant mb: btMultiBody (pybullet's default)."""
import pybullet as p, sys
OUT=sys.argv[1]
I=[1.,2.,3.];W0=[0.1,2.,0.1];h=0.01;N=1000
CASES=dict(top=(None,0.,None),torque=([0.3,0,0.2],0.,None),damped=(None,0.1,None),slow=(None,0.,[1e-4,5e-4,2e-4]),fast=(None,0.,[60.,70.,20.]),
 torquedamped=([0.3,0,0.2],0.1,None))
def run(variant,case):
    tau,c,w0=CASES[case];w0=w0 or W0
    p.resetSimulation();p.setGravity(0,0,0);p.setTimeStep(h);p.setPhysicsEngineParameter(numSubSteps=0,fixedTimeStep=h)
    col=p.createCollisionShape(p.GEOM_SPHERE,radius=0.5)
    b=p.createMultiBody(baseMass=1,baseCollisionShapeIndex=col,basePosition=[0,0,0],useMaximalCoordinates=1 if variant=="rb" else 0)
    p.changeDynamics(b,-1,localInertiaDiagonal=I,linearDamping=0,angularDamping=c,activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING)
    p.stepSimulation()  # at rest: pose stays; changeDynamics leaves the shape's world inverse inertia in place until a step renews it
    if variant=="mb": p.changeDynamics(b,-1,maxJointVelocity=1e9)
    p.resetBaseVelocity(b,[0,0,0],w0)
    rows=[]
    def rec(k):
        q=p.getBasePositionAndOrientation(b)[1];w=p.getBaseVelocity(b)[1]
        rows.append([k*h,*q,*w])
    rec(0)
    for k in range(1,N+1):
        if tau: p.applyExternalTorque(b,-1,tau,p.WORLD_FRAME)
        p.stepSimulation()
        if k<=3 or k%100==0: rec(k)
    with open(f"{OUT}/bullet_{variant}_{case}.csv","w") as f:
        f.write("t,qx,qy,qz,qw,wx,wy,wz\n")
        for r in rows: f.write(",".join("%.17g"%x for x in r)+"\n")
    return rows
if __name__=="__main__":
    p.connect(p.DIRECT)
    print("pybullet API",p.getAPIVersion(),"numpy",p.isNumpyEnabled())
    for v in ("rb","mb"):
        for c in CASES:
            r=run(v,c);print(v,c,r[1],r[-1])
