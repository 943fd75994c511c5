# SPDX-License-Identifier: Apache-2.0
"""The methods that the charts compare: the default, and what differs from it in one or two choices.
Label -> keys of `solver`."""


def cell(field):
    return {"anti_locking": {"control": "cell", "field": field}}


METHODS = {
    "linear": {},
    "linear, first": {"stress_update": "first"},
    "linear, last": {"stress_update": "last", "courant": 0.2},
    "linear, pic": {"transfer": "pic"},
    "linear, apic": {"transfer": "apic"},
    "linear, cell volumetric": cell("volumetric"),
    "linear, cell full": cell("full"),
    "linear, cell full_constant_volume": cell("full_constant_volume"),
    "linear, node volumetric": {"anti_locking": {"control": "node", "field": "volumetric"}},
    "linear, hybrid full": {"anti_locking": {"control": "hybrid", "field": "full"}},
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
