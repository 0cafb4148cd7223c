# SPDX-License-Identifier: MIT
# Rules for GNU Make: any mesh from the scene of the same name, mug.glb from mug.txt (or .scad, .csg).
#
#   CSGMESH_MESHES = mug.glb knob.stl      # what `make meshes` makes
#   CSGMESH_FLAGS = -r 64                  # for all; one mesh: mug.glb: CSGMESH_FLAGS += -D radius=5
#   CSGMESH_OUT = out                      # meshes are out/mug.glb instead
#   include csgmesh.mk                     # installed as PREFIX/share/csgmesh/make/csgmesh.mk
#
# What a scene reads (includes, imports, fonts) is noted beside the mesh, in mug.glb.d.
CSGMESH ?= csgmesh
CSGMESH_THREADS ?= 1
CSGMESH_OUT ?= .
CSGMESH_FORMATS ?= obj ply stl off gltf glb drc 3mf amf
CSGMESH_SCENE_SUFFIXES ?= txt scad csg

csgmesh_prefix := $(if $(filter-out .,$(CSGMESH_OUT)),$(CSGMESH_OUT)/)
csgmesh_targets = $(addprefix $(csgmesh_prefix),$(CSGMESH_MESHES))

.PHONY: meshes
meshes: $(csgmesh_targets)

define csgmesh_rule
$(csgmesh_prefix)%.$(1): %.$(2)
	@mkdir -p $$(@D)
	$$(CSGMESH) -j $$(CSGMESH_THREADS) $$(CSGMESH_FLAGS) $$< -o $$@ -M $$@.d
endef
$(foreach scene,$(CSGMESH_SCENE_SUFFIXES),$(foreach format,$(CSGMESH_FORMATS),$(eval $(call csgmesh_rule,$(format),$(scene)))))

-include $(addsuffix .d,$(csgmesh_targets))
