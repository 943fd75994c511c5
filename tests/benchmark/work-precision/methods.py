# SPDX-License-Identifier: Apache-2.0
"""The methods that the charts compare. Label -> keys of `solver`, the shape always among them: the
default is chosen by these charts. Without more the label is a shape's name (regret.py reads that)."""


def average(control, field):
    return {"anti_locking": {"control": control, "field": field}}


def cell(field):
    return average("cell", field)


LINEAR = {"shape": "linear"}


METHODS = {
    "linear": LINEAR,
    "linear, first": {"shape": "linear", "stress_update": "first"},
    "linear, last": {"shape": "linear", "stress_update": "last", "courant": 0.2},
    "linear, pic": {"shape": "linear", "transfer": "pic"},
    "linear, apic": {"shape": "linear", "transfer": "apic"},
    "linear, cell volumetric": dict(LINEAR, **cell("volumetric")),
    "linear, cell full": dict(LINEAR, **cell("full")),
    "linear, cell full_constant_volume": dict(LINEAR, **cell("full_constant_volume")),
    "linear, node volumetric": dict(LINEAR, **average("node", "volumetric")),
    "linear, hybrid full": dict(LINEAR, **average("hybrid", "full")),
    "gimp": {"shape": "gimp"},
    "gimp_scaled": {"shape": "gimp_scaled"},
    "gimp, cell volumetric": dict({"shape": "gimp"}, **cell("volumetric")),
    "cpdi": {"shape": "cpdi"},
    "cpdi_hybrid": {"shape": "cpdi_hybrid"},
    "cpdi, cell volumetric": dict({"shape": "cpdi"}, **cell("volumetric")),
    "bspline2": {"shape": "bspline2"},
    "bspline2, first": {"shape": "bspline2", "stress_update": "first"},
    "bspline2, last": {"shape": "bspline2", "stress_update": "last"},
    "bspline2, apic": {"shape": "bspline2", "transfer": "apic"},
    "bspline2, cell volumetric": dict({"shape": "bspline2"}, **cell("volumetric")),
    "bspline3": {"shape": "bspline3"},
    "bspline3, apic": {"shape": "bspline3", "transfer": "apic"},
    "bspline3, cell volumetric": dict({"shape": "bspline3"}, **cell("volumetric")),
    "quadratic": {"shape": "quadratic"},
}
