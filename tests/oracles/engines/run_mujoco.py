"""Free rigid body in MuJoCo itself (free joint, explicit inertia, no gravity). FOLDER/mujoco_<integrator>_<case>.csv:
t,qx,qy,qz,qw,wx,wy,wz; w is WORLD: MuJoCo's qvel[3:6] is body-frame; converted here by the rotation matrix of qpos (raw body w in *_body.csv)."""
import mujoco, numpy as np, sys
OUT=sys.argv[1]
W0=np.array([.1,2,.1]);h=0.01;N=1000
CASES=dict(top=(None,0.,None),torque=([0.3,0,0.2],0.,None),damped=(None,0.1,None),torquedamped=([0.3,0,0.2],0.1,None),fast=(None,0.,[60.,70.,20.]))
XML="""<mujoco><option timestep="%.17g" gravity="0 0 0" integrator="%s"/><worldbody><body><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="1 2 3"/></body></worldbody></mujoco>"""
def rot(q):
    R=np.zeros(9);mujoco.mju_quat2Mat(R,q);return R.reshape(3,3)
def run(integ,case):
    tau,c,w0=CASES[case]
    m=mujoco.MjModel.from_xml_string(XML.replace("diaginertia=\"1 2 3\"","diaginertia=\"1 2 3\"")%(h,integ))
    m.dof_damping[3:6]=c          # torque -c*w_body per axis: c in N m s/rad, NOT 1/s (no inertia factor)
    d=mujoco.MjData(m);d.qvel[3:]=W0 if w0 is None else w0   # q0 = identity: world = body
    if tau: d.xfrc_applied[1,3:]=tau   # world frame torque at the com
    rows=[];raw=[]
    def rec(k):
        q=d.qpos[3:];w=rot(q)@d.qvel[3:]
        rows.append([k*h,q[1],q[2],q[3],q[0],*w]);raw.append([k*h,q[1],q[2],q[3],q[0],*d.qvel[3:]])
    rec(0)
    for k in range(1,N+1):
        mujoco.mj_step(m,d)
        if k<=3 or k%100==0: rec(k)
    for name,R in (("",rows),("_body",raw)):
        with open(f"{OUT}/mujoco_{integ}_{case}{name}.csv","w") as f:
            f.write("t,qx,qy,qz,qw,wx,wy,wz\n")
            for r in R: f.write(",".join("%.17g"%x for x in r)+"\n")
    return rows
if __name__=="__main__":
    print("mujoco",mujoco.__version__)
    for i in ("RK4","Euler","implicit","implicitfast"):
        for c in CASES: print(i,c,run(i,c)[-1])
