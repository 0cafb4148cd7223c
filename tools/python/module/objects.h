/* SPDX-License-Identifier: MIT
 * What libcsgmesh makes, as objects of Python. Each holds the context that it was made with, and
 * arrays of Python hold the object whose memory they show.
 */
#ifndef CSGMESH_PYTHON_OBJECTS_H
#define CSGMESH_PYTHON_OBJECTS_H

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "module/context.h"

/* Points of the caller: without a copy, of this type, in rows of three. */
template <typename Number>
using Rows3 = nb::ndarray<Number, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

struct Scene {
    ContextPointer context;
    std::unique_ptr<csgm_scene, decltype(&csgm_scene_destroy)> scene{nullptr, csgm_scene_destroy};
};

/* Of libcsgmesh, or a view of arrays that the caller has. */
struct Mesh {
    ContextPointer context;
    std::unique_ptr<csgm_mesh, decltype(&csgm_mesh_destroy)> mesh{nullptr, csgm_mesh_destroy};
    csgm_mesh_view view{};
    std::vector<nb::object> arrays; /* that the view is of */
    std::vector<csgm_mesh_part> parts;
    std::list<std::string> names;
    nb::object stats = nb::none();
};

struct Image {
    ContextPointer context;
    std::unique_ptr<csgm_image, decltype(&csgm_image_destroy)> image{nullptr, csgm_image_destroy};
};

struct Diff {
    ContextPointer context;
    nb::object a, b; /* the meshes, whose views it looks at */
    std::unique_ptr<csgm_diff, decltype(&csgm_diff_destroy)> diff{nullptr, csgm_diff_destroy};
};

/* A field for the duration of a call. */
using FieldPointer = std::unique_ptr<csgm_field, decltype(&csgm_field_destroy)>;

/* (status, object or None). */
nb::tuple result_of(csgm_status status, nb::object object);

nb::tuple vector_of(const csgm_vec3 &v);
nb::tuple box_of(const csgm_box &box);
nb::object text_of(const char *text); /* UTF-8, or None */
nb::dict check_of(const csgm_mesh_check &check);

void define_scenes(nb::module_ &module);
void define_meshes(nb::module_ &module);
void define_pictures(nb::module_ &module);
void define_diffs(nb::module_ &module);
void define_measures(nb::module_ &module);
void define_layers(nb::module_ &module);

#endif
