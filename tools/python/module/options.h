/* SPDX-License-Identifier: MIT
 * Options from Python's keyword arguments: each struct of libcsgmesh has one table of its members.
 * What is no member, of the wrong type or out of range is a TypeError or ValueError that names it.
 */
#ifndef CSGMESH_PYTHON_OPTIONS_H
#define CSGMESH_PYTHON_OPTIONS_H

#include <nanobind/nanobind.h>

#include <list>
#include <string>
#include <vector>

#include "csgmesh/clearance.h"
#include "csgmesh/fabrication.h"
#include "csgmesh/slicing.h"

namespace nb = nanobind;

/* Texts and lists that options point to. */
struct Keep {
    std::list<std::string> texts;
    std::vector<csgm_define> defines;
    std::vector<const char *> folders, metadata, parts;
    std::vector<csgm_level> levels;

    const char *text(nb::handle bytes, const char *name);
};

void fill_context_options(csgm_context_options &options, nb::dict given);
void fill_scene_options(csgm_scene_options &options, nb::dict given, Keep &keep);
void fill_mesh_options(csgm_mesh_options &options, nb::dict given, Keep &keep);
void fill_write_options(csgm_write_options &options, nb::dict given, Keep &keep);
void fill_render_options(csgm_render_options &options, nb::dict given, Keep &keep);
void fill_diff_options(csgm_diff_options &options, nb::dict given, Keep &keep);
void fill_measure_options(csgm_measure_options &options, nb::dict given, Keep &keep);
void fill_wall_options(csgm_wall_options &options, nb::dict given, Keep &keep);
void fill_face_options(csgm_face_options &options, nb::dict given, Keep &keep);
void fill_clear_options(csgm_clear_options &options, nb::dict given, Keep &keep);
void fill_slice_options(csgm_slice_options &options, nb::dict given, Keep &keep);

/* option_names(kind): for those who check names before. */
void define_options(nb::module_ &module);

#endif
