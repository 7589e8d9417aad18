"""How long PyElastica takes to solve a plain description of one planar, straight beam, under settings that are chosen.

PyElastica's rod has shear and rotary inertia, which the description has not, and moves by an explicit method, whose steps every
stiffness limits. Both may be what costs least as long as their effect vanishes with the square of an element's length h, as the
rod's own error does: the shear stiffness is `shear` EI/h^2, the rotary inertia of a unit of length `inertia` rho A h^2.

- Equilibria are where a damped motion comes to rest. What is not of them is chosen here: the mass, and a stiffness against
  stretching of at most `stretch` EI/h^2. The unit of time is L^2 sqrt(rho A/EI); the motion takes `duration` of it with a damping of
  `damping` in its inverse.
- An element turns as a whole, so that holding the first would clamp the beam at its middle. A clamped rod therefore begins half an
  element before the beam; that element is held, and the beam has one half element less than the description.
- Steps are `limit` times an estimate of the longest that is stable, whatever the description says. PyElastica steps in Python, and
  its loop is what is timed; what Numba compiles is compiled before.
- Forces are N = EA e/(1 + e) for a stretch of 1 + e, as of a rod that keeps its volume.
"""

import json
import os
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read once, while NumPy is imported

import elastica as ea  # noqa: E402
import numpy as np  # noqa: E402

DEFAULT = {
    "shear": "12",
    "inertia": "0.1",
    "stretch": "1000",
    "duration": "3",
    "damping": "7",
    "limit": "0.9",
}


class Simulation(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    """A rod with supports, loads and damping."""


class Moment(ea.NoForces):
    """A moment about z on the last element."""

    def __init__(self, value):
        super().__init__()
        self.value = value

    def apply_torques(self, system, time=0.0):
        # torques are told in the element's own frame, whose first axis is z
        system.external_torques[0, -1] += self.value


class TipForce(ea.NoForces):
    """A dead force on the last node."""

    def __init__(self, value):
        super().__init__()
        self.value = np.array([*value, 0.0])

    def apply_forces(self, system, time=0.0):
        system.external_forces[:, -1] += self.value


def rod(given, chosen, static):
    """The rod, where it is held, the length of its elements and the longest stable step."""
    (beam,), (support,) = given["beams"], given["supports"]
    if given["joints"]:
        raise ValueError("beams must not be joined")
    if beam["axial_damping"] or beam["bending_damping"] or np.any(beam["velocities"]):
        raise ValueError("beams must start at rest and be without damping")
    if support["moved"] or support["node"] or not (support["x"] and support["y"]):
        raise ValueError("the support must hold the beam's first node")
    clamped = support["rotation"] != "free"
    number, length = len(beam["lengths"]), sum(beam["lengths"])
    h = length / (number - 0.5 if clamped else number)
    bend = beam["bending_stiffness"]
    stretch, mass = beam["axial_stiffness"], beam["mass_per_length"]
    if static:
        stretch, mass = min(stretch, chosen["stretch"] * bend / h**2), 1.0
    shear, inertia = chosen["shear"] * bend / h**2, chosen["inertia"] * mass * h**2
    along = np.array([*beam["tangent"], 0.0])
    made = ea.CosseratRod.straight_rod(
        number,
        np.array([*beam["nodes"][0], 0.0]) - (along * h / 2 if clamped else 0),
        along,
        np.array([0.0, 0.0, 1.0]),
        h * number,
        np.sqrt(1 / np.pi),  # area 1
        density=mass,
        youngs_modulus=stretch,
    )
    # Stiffnesses and inertias of its frame: z, across, along.
    made.shear_matrix[:] = np.diag([shear, shear, stretch])[:, :, None]
    made.bend_matrix[:] = np.diag([bend, bend, bend])[:, :, None]
    made.mass_second_moment_of_inertia[:] = np.eye(3)[:, :, None] * inertia * h
    made.inv_mass_second_moment_of_inertia[:] = np.eye(3)[:, :, None] / (inertia * h)
    fastest = np.sqrt(4 * max(stretch, shear) / mass + (shear * h**2 + 4 * bend) / inertia) / h
    return made, clamped, mass, 2 / fastest


def solve(given, chosen):
    """Seconds, and what is found."""
    ((kind, question),) = given["analysis"].items()
    static = kind == "static"
    made, clamped, mass, longest = rod(given, chosen, static)
    simulation = Simulation()
    simulation.append(made)
    if clamped:
        simulation.constrain(made).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    else:
        held = np.ones(3, bool)
        simulation.constrain(made).using(
            ea.GeneralConstraint,
            constrained_position_idx=(0,),
            translational_constraint_selector=held,
        )
    if any(given["gravity"]):
        simulation.add_forcing_to(made).using(ea.GravityForces, acc_gravity=np.array([*given["gravity"], 0.0]))
    for force in given["forces"]:
        simulation.add_forcing_to(made).using(TipForce, force["value"])
    for moment in given["moments"]:
        simulation.add_forcing_to(made).using(Moment, moment["value"])
    for load in given["forces"] + given["moments"]:
        if load["factors"] or load.get("follower") or load["node"] != made.n_elems:
            raise ValueError("loads must be on the last node, and neither follow time nor turn")
    if static:
        (beam,) = given["beams"]
        unit = sum(beam["lengths"]) ** 2 * np.sqrt(mass / beam["bending_stiffness"])
        duration, every = chosen["duration"] * unit, 1
        step = chosen["limit"] * longest
        steps = int(np.ceil(duration / step))
        simulation.dampen(made).using(
            ea.AnalyticalLinearDamper, uniform_damping_constant=chosen["damping"] / unit, time_step=step
        )
        records = 1
    else:
        records = question["steps"] // question["every"]
        spacing = question["every"] * question["step"]
        steps = int(np.ceil(spacing / (chosen["limit"] * longest)))
        step = spacing / steps
    simulation.finalize()
    stepper = ea.PositionVerlet()
    seconds, now, times, places = 0.0, 0.0, [], []
    if not static:
        times, places = [0.0], [made.position_collection[:2, -1].tolist()]
    for record in range(records):
        start = time.perf_counter()
        for _ in range(steps):
            now = stepper.step(simulation, now, step)
        seconds += time.perf_counter() - start
        place = made.position_collection[:2, -1].tolist()
        if not np.all(np.isfinite(place)):
            raise RuntimeError("the motion is unstable")
        times.append(1.0 if static else (record + 1) * spacing)
        places.append(place)
    x, y = zip(*places)
    for probe in given["probes"]:
        if probe["node"] != made.n_elems:
            raise ValueError("probes must be at the last node")
    found = {"steps": steps * records, "parameter": times}
    found["probes"] = [{"name": probe["name"], "x": x, "y": y} for probe in given["probes"]]
    if not clamped:
        found["nodes"] = [gradients(made)]
    return seconds, found


def gradients(made):
    """Place and gradient of every node; the gradient is that of the elements beside it, in the mean."""
    places = made.position_collection[:2].T
    slopes = np.diff(places, axis=0) / made.rest_lengths[:, None]
    first, last = (3 * slopes[0] - slopes[1]) / 2, (3 * slopes[-1] - slopes[-2]) / 2
    between = (slopes[1:] + slopes[:-1]) / 2
    return np.column_stack([places, np.vstack([first, between, last])]).tolist()


def compile_all():
    """Has Numba compile what the methods need, once, so that no measurement contains it."""
    beam = {
        "nodes": [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
        "tangent": [1.0, 0.0],
        "velocities": [[0.0] * 4] * 4,
        "lengths": [1.0] * 3,
        "axial_stiffness": 1.0,
        "bending_stiffness": 1.0,
        "mass_per_length": 1.0,
        "axial_damping": 0.0,
        "bending_damping": 0.0,
    }
    support = {"beam": 0, "node": 0, "x": True, "y": True, "moved": None}
    given = {"beams": [beam], "forces": [], "moments": [], "gravity": [0.0, 1.0], "probes": []}
    for rotation, analysis in (
        ("angle", {"static": {"steps": 1}}),
        ("free", {"dynamic": {"steps": 1, "step": 0.01, "every": 1, "spectral_radius": 1}}),
    ):
        moment = {"beam": 0, "node": 3, "value": 0.0, "factors": None}
        force = {**moment, "value": [0.0, 0.0], "follower": False}
        case = {**given, "forces": [force], "moments": [moment], "supports": [{**support, "rotation": rotation}]}
        solve({**case, "analysis": analysis}, numbers({"limit": "0.5", "duration": "0.1"}))


def numbers(settings):
    """All settings, those that are not chosen included."""
    unknown = settings.keys() - DEFAULT.keys()
    if unknown:
        raise ValueError(f"no setting of PyElastica is called {sorted(unknown)} here")
    chosen = {**DEFAULT, **settings}
    return {name: float(value) for name, value in chosen.items()}


compile_all()


def answer(text):
    """From {description, settings, repeat} as JSON to what PyElastica finds and how long each repetition took, as JSON."""
    question = json.loads(text)
    chosen = numbers(question["settings"])
    runs = [solve(question["description"], chosen) for _ in range(question["repeat"])]
    return json.dumps({"seconds": [seconds for seconds, _ in runs], **runs[-1][1]}, allow_nan=False)
