# SPDX-License-Identifier: Apache-2.0
"""Mistakes that users make in scenes: (what, change to a good scene, pointer that must be named).

A change is a list of (path, value); DELETE removes the key. The scene is a block over a floor with
a wall, so that every part of a scene is there to be broken."""

DELETE = object()

SAND = {"model": "matsuoka_nakai", "density": 2200, "bulk_modulus": 29.5e6, "shear_modulus": 13.6e6,
        "friction": {"a0": 35, "a1": 9, "a3": 0.3, "a4": 10, "strain_scale": 100},
        "dilation_angle": 0}
FLUID = {"model": "newtonian_fluid", "density": 1000, "bulk_modulus": 1e6, "viscosity": 1e-3}


def good_scene():
    return {
        "title": "block over a floor",
        "dimension": "plane_strain",
        "duration": 0.1,
        "grid": {"cell": 0.05, "min": [0, 0], "max": [1, 1]},
        "solver": {"kind": "explicit", "time_step": "auto", "shape": "linear", "strain": "finite"},
        "materials": {"rubber": {"model": "linear_elastic", "density": 1000, "young_modulus": 1e5,
                                 "poisson_ratio": 0.3}},
        "bodies": [{"name": "block", "material": "rubber",
                    "box": {"min": [0.2, 0.2], "max": [0.6, 0.6]}, "particles_per_cell": [2, 2]}],
        "gravity": [0, -9.81],
        "boundaries": [
            {"name": "floor", "plane": {"point": [0, 0], "normal": [0, 1]}, "condition": "stick"},
            {"name": "wall", "box": {"min": [0.8, 0], "max": [0.9, 0.5]}, "condition": "slip"},
        ],
        "probes": [{"name": "top", "kind": "height"},
                   {"name": "load", "kind": "reaction", "boundary": "wall", "component": "x"}],
        "references": [{"probe": "top", "value": 0.5}],
        "output": {"frames": {"every": 0.05, "fields": ["velocity"]}, "history": {"every": 0.01}},
    }


def broken(changes):
    scene = good_scene()
    for path, value in changes:
        keys = [int(key) if key.isdigit() else key for key in path.strip("/").split("/")]
        place = scene
        for key in keys[:-1]:
            place = place[key]
        if value is DELETE:
            del place[keys[-1]]
        else:
            place[keys[-1]] = value
    return scene


def one(what, path, value, pointer=None):
    return what, [(path, value)], pointer or path


MISTAKES = [
    # what is missing
    one("no dimension", "/dimension", DELETE),
    one("no duration", "/duration", DELETE),
    one("no grid", "/grid", DELETE),
    one("no materials", "/materials", DELETE),
    one("no bodies", "/bodies", DELETE),
    one("no cell", "/grid/cell", DELETE),
    one("no grid minimum", "/grid/min", DELETE),
    one("no grid maximum", "/grid/max", DELETE),
    one("no model", "/materials/rubber/model", DELETE),
    one("no density", "/materials/rubber/density", DELETE),
    one("no material of a body", "/bodies/0/material", DELETE),
    one("no condition", "/boundaries/0/condition", DELETE),
    one("no normal", "/boundaries/0/plane/normal", DELETE),
    one("no kind of probe", "/probes/0/kind", DELETE),
    # misspelt
    one("unknown key at the top", "/durration", 1),
    one("unknown key of the grid", "/grid/cells", 5),
    one("unknown key of the solver", "/solver/timestep", 1e-5),
    one("unknown key of a material", "/materials/rubber/youngs_modulus", 1e5),
    one("unknown key of a body", "/bodies/0/velocty", [0, 0]),
    one("unknown key of a boundary", "/boundaries/0/frictoin", 1),
    one("unknown key of a probe", "/probes/0/boddy", "block"),
    one("unknown key of the output", "/output/frame", {}),
    one("unknown dimension", "/dimension", "plane_stran"),
    one("unknown kind of solver", "/solver/kind", "implicit"),
    one("unknown shape function", "/solver/shape", "cubic"),
    one("unknown strain", "/solver/strain", "large"),
    one("unknown model", "/materials/rubber/model", "linear_elastc"),
    one("unknown condition", "/boundaries/0/condition", "sticky"),
    one("unknown kind of probe", "/probes/0/kind", "hight"),
    one("unknown field", "/output/frames/fields", ["velocity", "colour"], "/output/frames/fields/1"),
    # wrong type
    one("duration as text", "/duration", "1 s"),
    one("dimension as a number", "/dimension", 2),
    one("grid as an array", "/grid", [1, 1]),
    one("bodies as an object", "/bodies", {}),
    one("a body as text", "/bodies/0", "block"),
    one("title as a number", "/title", 5),
    one("gravity as a number", "/gravity", -9.81),
    one("a component as text", "/gravity", [0, "-9.81"], "/gravity/1"),
    one("null", "/duration", None),
    # vectors of the wrong length
    one("grid minimum in 3D", "/grid/min", [0, 0, 0]),
    one("gravity in 3D", "/gravity", [0, 0, -9.81]),
    one("box corner in 1D", "/bodies/0/box/min", [0.2]),
    one("normal in 3D", "/boundaries/0/plane/normal", [0, 0, 1]),
    one("particles per cell in 3D", "/bodies/0/particles_per_cell", [2, 2, 2]),
    # out of range
    one("duration zero", "/duration", 0),
    one("duration negative", "/duration", -1),
    one("cell zero", "/grid/cell", 0),
    one("cell negative", "/grid/cell", -0.05),
    one("density zero", "/materials/rubber/density", 0),
    one("density negative", "/materials/rubber/density", -1000),
    one("Young's modulus negative", "/materials/rubber/young_modulus", -1),
    one("Poisson's ratio 0.5", "/materials/rubber/poisson_ratio", 0.5),
    one("Poisson's ratio -1", "/materials/rubber/poisson_ratio", -1),
    one("courant zero", "/solver/courant", 0),
    one("time step negative", "/solver/time_step", -1e-5),
    one("time step as a word", "/solver/time_step", "automatic"),
    one("particles per cell zero", "/bodies/0/particles_per_cell", [0, 2], "/bodies/0/particles_per_cell/0"),
    one("history every zero", "/output/history/every", 0),
    one("normal of length zero", "/boundaries/0/plane/normal", [0, 0]),
    # what contradicts
    one("grid upside down", "/grid/max", [-1, 1], None),
    one("box upside down", "/bodies/0/box/max", [0.1, 0.6], None),
    one("unknown material", "/bodies/0/material", "ruber"),
    one("unknown boundary of a probe", "/probes/1/boundary", "wal"),
    one("unknown probe of a reference", "/references/0/probe", "bottom"),
    one("no body at all", "/bodies", []),
    ("two shapes", [("/bodies/0/sphere", {"centre": [0.4, 0.4], "radius": 0.1})], "/bodies/0"),
    ("no shape", [("/bodies/0/box", DELETE)], "/bodies/0"),
    ("two lattices", [("/bodies/0/spacing", 0.01)], "/bodies/0"),
    ("no lattice", [("/bodies/0/particles_per_cell", DELETE)], "/bodies/0"),
    ("two pairs of elastic constants", [("/materials/rubber/bulk_modulus", 1e5)], "/materials/rubber"),
    ("half a pair", [("/materials/rubber/poisson_ratio", DELETE)], "/materials/rubber"),
    ("two boundaries of one name", [("/boundaries/1/name", "floor")], "/boundaries/1/name"),
    ("two bodies of one name", [("/bodies", [
        {"name": "a", "material": "rubber", "box": {"min": [0.2, 0.2], "max": [0.3, 0.3]},
         "particles_per_cell": [2, 2]},
        {"name": "a", "material": "rubber", "box": {"min": [0.4, 0.2], "max": [0.5, 0.3]},
         "particles_per_cell": [2, 2]}])], "/bodies/1/name"),
    ("two probes of one name", [("/probes/1/name", "top")], "/probes/1/name"),
    ("friction without a coefficient", [("/boundaries/0/condition", "friction")], "/boundaries/0"),
    ("a coefficient without friction", [("/boundaries/0/friction_coefficient", 0.3)], "/boundaries/0"),
    ("body outside of the grid", [("/bodies/0/box/max", [0.6, 1.6])], "/bodies/0"),
    ("body inside an obstacle", [("/bodies/0/box", {"min": [0.7, 0.2], "max": [0.9, 0.4]})], "/bodies/0"),
    ("a probe of a field without a field", [("/probes/0/kind", "point")], "/probes/0"),
    ("a face that a box has not", [("/probes/1/face", "z_max")], "/probes/1/face"),
    ("time step above the critical one", [("/solver/time_step", 1.0)], "/solver/time_step"),
    # models
    ("fluid with a Young's modulus", [("/materials/rubber", dict(FLUID, young_modulus=1e5))],
     "/materials/rubber/young_modulus"),
    ("fluid with a negative viscosity", [("/materials/rubber", dict(FLUID, viscosity=-1))],
     "/materials/rubber/viscosity"),
    ("sand without friction", [("/materials/rubber", {k: v for k, v in SAND.items() if k != "friction"})],
     "/materials/rubber"),
    ("sand with an unknown coefficient", [("/materials/rubber", dict(SAND, friction={"a0": 35, "a9": 1}))],
     "/materials/rubber/friction/a9"),
    ("sand with friction of 100 degrees", [("/materials/rubber", dict(SAND, friction={"a0": 100}))],
     "/materials/rubber/friction"),
    # too much
    ("a grid that overflows", [("/grid/cell", 1e-300)], "/grid"),
    ("a million million particles", [("/bodies/0/particles_per_cell", [1000000, 1000000])], "/bodies/0"),
    ("spacing of an atom", [("/bodies/0/particles_per_cell", DELETE), ("/bodies/0/spacing", 1e-10)],
     "/bodies/0"),
    ("a grid of 1e30 cells", [("/grid/max", [1e15, 1e15]), ("/grid/cell", 1e-0)], "/grid"),
    ("a duration without end", [("/duration", 1e300)], "/duration"),
    # what single precision would lose
    ("a stiff block that creeps, in single precision",
     [("/solver/precision", "single"), ("/materials/rubber/young_modulus", 1e13)],
     "/solver/precision"),
    # promised, not built
    ("quasi-static", [("/solver/kind", "quasi_static")], "/solver/kind"),
    ("plane stress with a fluid",
     [("/dimension", "plane_stress"), ("/materials/rubber", FLUID)], "/materials/rubber/model"),
    ("gravity away from the axis",
     [("/dimension", "axisymmetric"), ("/gravity", [1, -9.81])], "/gravity/0"),
    ("a grid beyond the axis", [("/dimension", "axisymmetric"), ("/grid/min", [-1, 0])],
     "/grid/min/0"),
    ("phases", [("/phases", {})], "/phases"),
]
