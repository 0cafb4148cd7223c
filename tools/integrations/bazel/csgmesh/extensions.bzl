# SPDX-License-Identifier: MIT
"""For MODULE.bazel: the csgmesh of this machine; see docs/batch.md.

    csgmesh = use_extension("@rules_csgmesh//:extensions.bzl", "csgmesh")
    use_repo(csgmesh, "csgmesh")
"""

load(":csgmesh.bzl", "csgmesh_local")

def _csgmesh_impl(_module):
    csgmesh_local(name = "csgmesh")

csgmesh = module_extension(implementation = _csgmesh_impl)
