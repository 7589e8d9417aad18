"""How long MuJoCo takes to solve a plain description of one planar, straight beam, under settings that are chosen.

MuJoCo has no beam. Its cable plugin is a chain of rigid bodies with elastic joints in space; here is such a chain in the plane, of a
rigid link for every element of length h and a hinge with a spring EI/h between two. It errs with h^2. Links do not stretch; with
`stretch` a joint that slides on a spring EA/h lets them.

- The joint at the support stands for half an element: its springs are twice as stiff.
- Equilibria are where a damped chain almost without mass comes to rest. Every hinge has a damper of its stiffness times a unit of
  time, which the integrator `implicitfast` takes implicitly; a step is `step` of that unit, and there are `steps`. Steps of one unit are
  those of a Newton method whose stiffness is the springs' alone, for a moment exact, as it bends every hinge by as much.
- Motions are by `integrator`, with the steps of the description.
- Timed is the call of `mj_step` alone, which makes all steps between two records.
"""

import json
import time

import mujoco
import numpy as np

# It would write a file of warnings into the current folder; what it counts of them is asked for instead.
mujoco.set_mju_user_warning(lambda message: None)

DEFAULT = {"integrator": "RK4", "stretch": "0", "step": "1", "steps": "4"}


class Chain:
    """The model in MuJoCo."""

    def __init__(self, given, chosen):
        (beam,), (support,) = given["beams"], given["supports"]
        if given["joints"]:
            raise ValueError("beams must not be joined")
        self.static, self.beam = "static" in given["analysis"], beam
        if beam["axial_damping"] or beam["bending_damping"] or np.any(beam["velocities"]):
            raise ValueError("beams must start at rest and be without damping")
        if support["moved"] or support["node"] or not (support["x"] and support["y"]):
            raise ValueError("the support must hold the beam's first node")
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        spec.option.gravity = [*given["gravity"], 0]
        integrator = "implicitfast" if self.static else chosen["integrator"]
        spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        spec.option.timestep = float(chosen["step"]) if self.static else given["analysis"]["dynamic"]["step"]
        self.add_links(spec, support["rotation"] != "free", chosen["stretch"] == "1")
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        tip = self.model.body("tip").id
        for load in given["forces"] + given["moments"]:
            if load["factors"] or load.get("follower") or load["node"] != len(beam["lengths"]):
                raise ValueError("loads must be on the last node, and neither follow time nor turn")
        for force in given["forces"]:
            self.data.xfrc_applied[tip, :2] += force["value"]
        for moment in given["moments"]:
            self.data.xfrc_applied[tip, 5] += moment["value"]
        if any(probe["node"] != len(beam["lengths"]) for probe in given["probes"]):
            raise ValueError("probes must be at the last node")
        mujoco.mj_forward(self.model, self.data)

    def add_links(self, spec, clamped, stretches):
        beam, h = self.beam, self.beam["lengths"][0]
        bend, stretch = beam["bending_stiffness"] / h, beam["axial_stiffness"] / h
        mass = beam["mass_per_length"] * h
        if self.static:
            # With more the slowest motion of many links is not damped enough; with less MuJoCo refuses the accelerations of few.
            mass = min(1e-8, 0.3 / len(beam["lengths"]) ** 4) * bend / h**2
        # What turns in the plane alone has one moment of inertia; that about the axis must not be zero.
        inertia = mass * h**2 / 12 * np.array([1e-3, 1, 1])
        body = spec.worldbody
        half = np.arctan2(*beam["tangent"][::-1]) / 2
        for k in range(len(beam["lengths"])):
            twice = 1 if k else 2
            where = {"pos": [h, 0, 0]}
            if k == 0:
                where = {"pos": [*beam["nodes"][0], 0], "quat": [np.cos(half), 0, 0, np.sin(half)]}
            body = body.add_body(**where, mass=mass, ipos=[h / 2, 0, 0], inertia=inertia, explicitinertial=True)
            spring = twice * bend if k or clamped else 0
            damping = spring if self.static else 0
            body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1], stiffness=spring, damping=damping)
            if stretches:
                body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0], stiffness=twice * stretch)
        # Loads act at the centre of a body. This one is the tip, of no mass to speak of.
        nothing = {"mass": 1e-6 * mass, "inertia": 1e-6 * inertia, "explicitinertial": True}
        body.add_body(name="tip", pos=[h, 0, 0], ipos=[0, 0, 0], **nothing)

    def go(self, steps):
        """Seconds that MuJoCo takes for these steps."""
        start = time.perf_counter()
        mujoco.mj_step(self.model, self.data, nstep=steps)
        seconds = time.perf_counter() - start
        if any(warning.number for warning in self.data.warning):
            raise RuntimeError("the motion is unstable")
        mujoco.mj_kinematics(self.model, self.data)
        return seconds

    def tip(self):
        return self.data.xpos[-1, :2].tolist()

    def gradients(self):
        """Place and gradient of every node; the gradient is that of the links beside it, in the mean."""
        places = self.data.xpos[1:, :2]
        slopes = np.diff(places, axis=0) / np.array(self.beam["lengths"])[:, None]
        first, last = (3 * slopes[0] - slopes[1]) / 2, (3 * slopes[-1] - slopes[-2]) / 2
        return np.column_stack([places, np.vstack([first, (slopes[1:] + slopes[:-1]) / 2, last])]).tolist()


def solve(given, chosen):
    """Seconds, and what is found."""
    chain = Chain(given, chosen)
    ((kind, question),) = given["analysis"].items()
    if kind == "static":
        steps = int(chosen["steps"])
        seconds = chain.go(steps)
        times, places = [1.0], [chain.tip()]
    else:
        steps, every = question["steps"], question["every"]
        seconds, times, places = 0.0, [0.0], [chain.tip()]
        for record in range(1, steps // every + 1):
            seconds += chain.go(every)
            times.append(record * every * question["step"])
            places.append(chain.tip())
    x, y = zip(*places)
    return seconds, {
        "steps": steps,
        "parameter": times,
        "probes": [{"name": probe["name"], "x": x, "y": y} for probe in given["probes"]],
        "nodes": [chain.gradients()],
    }


def answer(text):
    """From {description, settings, repeat} as JSON to what MuJoCo finds and how long each repetition took, as JSON."""
    question = json.loads(text)
    unknown = question["settings"].keys() - DEFAULT.keys()
    if unknown:
        raise ValueError(f"no setting of MuJoCo is called {sorted(unknown)} here")
    chosen = {**DEFAULT, **question["settings"]}
    runs = [solve(question["description"], chosen) for _ in range(question["repeat"])]
    return json.dumps({"seconds": [seconds for seconds, _ in runs], **runs[-1][1]}, allow_nan=False)
