/* SPDX-License-Identifier: MIT
 * The tables of options; see options.h.
 */
#include "module/options.h"

#include "module/objects.h"

#include <nanobind/stl/string.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace
{

/* ---- values ------------------------------------------------------------------------------------ */

[[noreturn]] void refuse(PyObject *kind, const std::string &name, const std::string &wanted,
                         nb::handle value)
{
    std::string given = nb::cast<std::string>(nb::repr(value));
    if (given.size() > 60)
        given = given.substr(0, 57) + "...";
    PyErr_SetString(kind, (name + " must be " + wanted + ", not " + given).c_str());
    throw nb::python_error();
}

double number_of(nb::handle value, const std::string &name)
{
    double number = PyBool_Check(value.ptr()) || PyUnicode_Check(value.ptr())
                        ? (PyErr_SetNone(PyExc_TypeError), -1.0)
                        : PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred()) {
        PyErr_Clear();
        refuse(PyExc_TypeError, name, "a number", value);
    }
    if (std::isnan(number))
        refuse(PyExc_ValueError, name, "a number", value);
    return number;
}

void take(double &member, nb::handle value, const char *name, Keep &)
{
    member = number_of(value, name);
}

void take(bool &member, nb::handle value, const char *name, Keep &)
{
    int truth = PyBool_Check(value.ptr()) || nb::hasattr(value, "dtype")
                    ? PyObject_IsTrue(value.ptr())
                    : -1;
    if (truth < 0)
        refuse(PyExc_TypeError, name, "True or False", value);
    member = truth;
}

template <typename Whole>
std::enable_if_t<std::is_integral_v<Whole> && !std::is_same_v<Whole, bool>>
take(Whole &member, nb::handle value, const char *name, Keep &)
{
    nb::object index =
        PyBool_Check(value.ptr()) ? nb::object() : nb::steal(PyNumber_Index(value.ptr()));
    if (!index.is_valid()) {
        PyErr_Clear();
        refuse(PyExc_TypeError, name, "a whole number", value);
    }
    using Limits = std::numeric_limits<Whole>;
    int overflow = 0;
    unsigned long long most = (unsigned long long)Limits::max();
    long long number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    bool fits = overflow == 0 && number >= (long long)Limits::min() &&
                (number < 0 || (unsigned long long)number <= most);
    if (!fits)
        refuse(PyExc_ValueError, name,
               "a whole number from " + std::to_string(Limits::min()) + " to " +
                   std::to_string(std::min(most, (unsigned long long)INT64_MAX)),
               value);
    member = (Whole)number;
}

void take_numbers(double *members, size_t count, nb::handle value, const char *name,
                  const char *wanted)
{
    nb::object list = nb::steal(PySequence_List(value.ptr()));
    if (!list.is_valid() || PyUnicode_Check(value.ptr())) {
        PyErr_Clear();
        refuse(PyExc_TypeError, name, wanted, value);
    }
    if (nb::len(list) != count)
        refuse(PyExc_ValueError, name, wanted, value);
    for (size_t i = 0; i < count; i++)
        members[i] = number_of(list[i], std::string(name) + "[" + std::to_string(i) + "]");
}

void take(csgm_vec3 &member, nb::handle value, const char *name, Keep &)
{
    double numbers[3];
    take_numbers(numbers, 3, value, name, "three numbers");
    member = {numbers[0], numbers[1], numbers[2]};
}

void take(csgm_box &member, nb::handle value, const char *name, Keep &keep)
{
    nb::object list = nb::steal(PySequence_List(value.ptr()));
    if (!list.is_valid() || nb::len(list) != 2) {
        PyErr_Clear();
        refuse(PyExc_ValueError, name, "two corners, ((x, y, z), (x, y, z))", value);
    }
    take(member.min, list[0], name, keep);
    take(member.max, list[1], name, keep);
}

void take(uint8_t (&member)[4], nb::handle value, const char *name, Keep &)
{
    double numbers[4];
    take_numbers(numbers, 4, value, name, "four numbers from 0 to 255");
    for (int i = 0; i < 4; i++) {
        if (!(numbers[i] >= 0 && numbers[i] <= 255))
            refuse(PyExc_ValueError, name, "four numbers from 0 to 255", value);
        member[i] = (uint8_t)numbers[i];
    }
}

void take(const char *&member, nb::handle value, const char *name, Keep &keep)
{
    member = keep.text(value, name);
}

/* One of these words, in the order of the enum. */
template <typename Enum>
void choose(Enum &member, nb::handle value, const char *name,
            std::initializer_list<const char *> words)
{
    int at = 0;
    std::string wanted;
    std::string given = PyUnicode_Check(value.ptr()) ? nb::cast<std::string>(value) : "";
    for (const char *word : words) {
        if (given == word) {
            member = (Enum)at;
            return;
        }
        bool last = ++at == (int)words.size();
        wanted += (at == 1 ? "'" : last ? " or '" : ", '") + std::string(word) + "'";
    }
    refuse(PyUnicode_Check(value.ptr()) ? PyExc_ValueError : PyExc_TypeError, name, wanted, value);
}

/* ---- tables ------------------------------------------------------------------------------------ */

template <typename Options> struct Row {
    const char *name;
    void (*take)(Options &options, nb::handle value, const char *name, Keep &keep);
};

template <typename Options, size_t COUNT>
void fill(Options &options, nb::dict given, const Row<Options> (&rows)[COUNT], Keep &keep)
{
    for (auto [key, value] : given) {
        std::string name = nb::cast<std::string>(key);
        const Row<Options> *found = nullptr;
        for (const Row<Options> &row : rows)
            found = name == row.name ? &row : found;
        if (!found) {
            PyErr_Format(PyExc_TypeError, "there is no option '%s'", name.c_str());
            throw nb::python_error();
        }
        if (!value.is_none())
            found->take(options, value, found->name, keep);
    }
}

template <typename Options, size_t COUNT> nb::list names(const Row<Options> (&rows)[COUNT])
{
    nb::list out;
    for (const Row<Options> &row : rows)
        out.append(row.name);
    return out;
}

/* A member of its own name; one of another name or below; one of some words. */
#define MEMBER(type, member) NAMED(type, #member, member)
#define NAMED(type, name, member)                                                                  \
    {                                                                                              \
        name, [](type &o, nb::handle v, const char *n, Keep &k) { take(o.member, v, n, k); }       \
    }
#define CHOICE(type, name, member, ...)                                                            \
    {                                                                                              \
        name, [](type &o, nb::handle v, const char *n, Keep &) {                                   \
            choose(o.member, v, n, {__VA_ARGS__});                                                 \
        }                                                                                          \
    }

#define OF(member) MEMBER(csgm_context_options, member)
#define LIMIT(name, member) NAMED(csgm_context_options, name, limits.member)
const Row<csgm_context_options> context_rows[] = {
    OF(threads),
    OF(warnings_as_errors),
    OF(library_warnings),
    CHOICE(csgm_context_options, "isa", isa, "auto", "scalar", "sse2", "avx2", "avx512", "neon"),
    LIMIT("max_depth", depth),
    LIMIT("max_nodes", scene_nodes),
    LIMIT("max_steps", eval_steps),
    LIMIT("max_memory", memory_bytes),
    LIMIT("timeout", timeout_s),
};
#undef OF
#undef LIMIT

void take_defines(csgm_scene_options &options, nb::handle value, const char *, Keep &keep)
{
    for (auto [name, expression] : nb::cast<nb::dict>(value))
        keep.defines.push_back({keep.text(name, "define"), keep.text(expression, "define")});
    options.defines = keep.defines.data();
    options.define_count = keep.defines.size();
}

void take_folders(csgm_scene_options &options, nb::handle value, const char *name, Keep &keep)
{
    for (nb::handle folder : nb::cast<nb::list>(value))
        keep.folders.push_back(keep.text(folder, name));
    options.include_dirs = keep.folders.data();
    options.include_dir_count = keep.folders.size();
}

#define OF(member) MEMBER(csgm_scene_options, member)
const Row<csgm_scene_options> scene_rows[] = {
    {"define", take_defines},
    {"include", take_folders},
    OF(parameter_file),
    OF(parameter_set),
    CHOICE(csgm_scene_options, "facets", facets, "round", "exact"),
    CHOICE(csgm_scene_options, "leniency", leniency, "strict", "by_file", "lenient"),
    OF(openscad_version),
    CHOICE(csgm_scene_options, "flat", flat, "plate", "drawing", "both", "kept"),
    OF(only_check),
};
#undef OF

#define OF(member) MEMBER(csgm_mesh_options, member)
const Row<csgm_mesh_options> mesh_rows[] = {
    OF(bounds),
    OF(cell_size),
    OF(resolution),
    CHOICE(csgm_mesh_options, "normals", normals, "none", "vertex", "crease"),
    CHOICE(csgm_mesh_options, "features", features, "sharp", "smooth"),
    OF(colors),
    OF(prune),
    OF(tolerance),
    OF(simplify_error),
    OF(simplify_share),
    OF(improve),
    OF(certify),
    OF(certify_size),
    CHOICE(csgm_mesh_options, "quality", quality, "normal", "draft", "fine"),
    OF(triangles),
};
#undef OF

void take_metadata(csgm_write_options &options, nb::handle value, const char *name, Keep &keep)
{
    for (nb::handle text : nb::cast<nb::list>(value))
        keep.metadata.push_back(keep.text(text, name));
    options.metadata = keep.metadata.data();
    options.metadata_count = keep.metadata.size();
}

/* A coarser mesh each, how far it is from the solid, what was measured, whether that is proven. */
void take_levels(csgm_write_options &options, nb::handle value, const char *name, Keep &keep)
{
    static const char *const wanted = "a list of (mesh, error, measured, proven)";
    for (nb::handle item : nb::cast<nb::list>(value)) {
        nb::tuple level = nb::cast<nb::tuple>(item);
        Mesh *mesh;
        if (nb::len(level) != 4 || !nb::try_cast(level[0], mesh))
            refuse(PyExc_TypeError, name, wanted, value);
        keep.levels.push_back({mesh->view, number_of(level[1], name), number_of(level[2], name),
                               nb::cast<bool>(level[3])});
    }
    options.levels = keep.levels.data();
    options.level_count = keep.levels.size();
}

#define OF(member) MEMBER(csgm_write_options, member)
const Row<csgm_write_options> write_rows[] = {
    OF(ascii),
    OF(draco),
    OF(draco_position_bits),
    OF(draco_normal_bits),
    OF(draco_color_bits),
    OF(draco_level),
    OF(y_up),
    OF(sync),
    OF(only_if_changed),
    CHOICE(csgm_write_options, "unit", unit, "none", "mm", "cm", "m", "in"),
    OF(comment),
    {"metadata", take_metadata},
    OF(meshopt),
    OF(meshopt_khr),
    CHOICE(csgm_write_options, "uv", uv, "none", "box", "cylinder"),
    {"levels", take_levels},
};
#undef OF

void take_slice(csgm_render_options &options, nb::handle value, const char *name, Keep &keep)
{
    static const char *const wanted = "an axis and a place on it, as ('z', 10)";
    nb::object list = nb::steal(PySequence_List(value.ptr()));
    if (!list.is_valid() || nb::len(list) != 2) {
        PyErr_Clear();
        refuse(PyExc_TypeError, name, wanted, value);
    }
    choose(options.slice_axis, list[0], "slice[0]", {"x", "y", "z"});
    take(options.slice_at, list[1], "slice[1]", keep);
}

void take_view(csgm_render_options &options, nb::handle value, const char *name, Keep &)
{
    double angles[2];
    take_numbers(angles, 2, value, name, "azimuth and elevation in degrees");
    options.camera.azimuth_deg = angles[0];
    options.camera.elevation_deg = angles[1];
}

void take_eye(csgm_render_options &options, nb::handle value, const char *name, Keep &keep)
{
    take(options.camera.eye, value, name, keep);
    options.camera.placed = true;
}

#define OF(member) MEMBER(csgm_render_options, member)
#define CAMERA(name, member) NAMED(csgm_render_options, name, camera.member)
const Row<csgm_render_options> render_rows[] = {
    OF(width),
    OF(height),
    OF(samples),
    {"view", take_view},
    {"eye", take_eye},
    CAMERA("target", target),
    CAMERA("up", up),
    CHOICE(csgm_render_options, "projection", camera.projection, "perspective", "orthographic"),
    CAMERA("fov", fov_deg),
    CAMERA("view_height", height),
    CAMERA("zoom", zoom),
    OF(frame),
    OF(turns),
    OF(background),
    OF(occlusion),
    OF(shadows),
    OF(ground),
    OF(edges),
    OF(bounds),
    {"slice", take_slice},
    OF(iso_step),
    OF(wireframe),
    OF(flat),
    CHOICE(csgm_render_options, "evaluator", evaluator, "fast", "lazy"),
    OF(lazy),
    OF(bounds_used),
};
#undef OF
#undef CAMERA

void take_ignored(csgm_diff_options &options, nb::handle value, const char *, Keep &)
{
    for (nb::handle word : nb::cast<nb::list>(value)) {
        int at = 0;
        choose(at, word, "ignore", {"order", "normals", "colors", "names", "up", "topology"});
        options.ignored |= 1u << at;
    }
}

#define OF(member) MEMBER(csgm_diff_options, member)
const Row<csgm_diff_options> diff_rows[] = {
    OF(tolerance),
    OF(tolerance_relative),
    OF(tolerance_volume),
    CHOICE(csgm_diff_options, "material", material, "any", "added", "removed"),
    {"ignore", take_ignored},
    OF(samples),
    OF(verdict_only),
};
#undef OF

#define OF(member) MEMBER(csgm_measure_options, member)
const Row<csgm_measure_options> measure_rows[] = {
    OF(tolerance),
    OF(density),
    OF(part),
    OF(most_cubes),
};
#undef OF

#define OF(member) MEMBER(csgm_wall_options, member)
const Row<csgm_wall_options> wall_rows[] = {
    OF(tolerance), OF(finest), OF(angle_deg), OF(part), OF(most_pairs),
};
#undef OF

#define OF(member) MEMBER(csgm_face_options, member)
const Row<csgm_face_options> face_rows[] = {
    OF(up),
    OF(overhang_deg),
    OF(draft_deg),
    OF(part),
};
#undef OF

void take_parts(csgm_clear_options &options, nb::handle value, const char *name, Keep &keep)
{
    for (nb::handle part : nb::cast<nb::list>(value))
        keep.parts.push_back(keep.text(part, name));
    options.parts = keep.parts.data();
    options.part_count = keep.parts.size();
}

#define OF(member) MEMBER(csgm_clear_options, member)
const Row<csgm_clear_options> clear_rows[] = {
    OF(tolerance),
    OF(min_gap),
    {"parts", take_parts},
    OF(most_pairs),
};
#undef OF

/* The height of all layers, or that of the lowest and that of the highest. */
void take_layer(csgm_slice_options &options, nb::handle value, const char *name, Keep &keep)
{
    double heights[2];
    if (PyTuple_Check(value.ptr()) || PyList_Check(value.ptr())) {
        take_numbers(heights, 2, value, name, "a number, or the least and the largest height");
        options.height = heights[0];
        options.most_height = heights[1];
    } else {
        take(options.height, value, name, keep);
    }
}

#define OF(member) MEMBER(csgm_slice_options, member)
const Row<csgm_slice_options> slice_rows[] = {
    {"layer", take_layer},
    OF(cusp),
    OF(tolerance),
    CHOICE(csgm_slice_options, "unit", unit, "none", "mm", "cm", "m", "in"),
    OF(pixel),
    OF(sync),
    OF(part),
};
#undef OF

} // namespace

const char *Keep::text(nb::handle value, const char *name)
{
    if (!PyBytes_Check(value.ptr()))
        refuse(PyExc_TypeError, name, "a text", value);
    nb::bytes bytes = nb::cast<nb::bytes>(value);
    if (std::memchr(bytes.c_str(), 0, bytes.size()))
        refuse(PyExc_ValueError, name, "a text without zero bytes", value);
    return texts.emplace_back(bytes.c_str(), bytes.size()).c_str();
}

void fill_context_options(csgm_context_options &options, nb::dict given)
{
    Keep keep;
    fill(options, given, context_rows, keep);
}

void fill_scene_options(csgm_scene_options &options, nb::dict given, Keep &keep)
{
    options.leniency = CSGM_LENIENT_BY_FILE; /* as the command line has it */
    fill(options, given, scene_rows, keep);
}

void fill_mesh_options(csgm_mesh_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, mesh_rows, keep);
}

void fill_write_options(csgm_write_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, write_rows, keep);
}

void fill_render_options(csgm_render_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, render_rows, keep);
}

void fill_diff_options(csgm_diff_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, diff_rows, keep);
}

void fill_measure_options(csgm_measure_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, measure_rows, keep);
}

void fill_wall_options(csgm_wall_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, wall_rows, keep);
}

void fill_face_options(csgm_face_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, face_rows, keep);
}

void fill_clear_options(csgm_clear_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, clear_rows, keep);
}

void fill_slice_options(csgm_slice_options &options, nb::dict given, Keep &keep)
{
    fill(options, given, slice_rows, keep);
}

void define_options(nb::module_ &module)
{
    nb::dict all;
    all["run"] = names(context_rows);
    all["scene"] = names(scene_rows);
    all["mesh"] = names(mesh_rows);
    all["write"] = names(write_rows);
    all["render"] = names(render_rows);
    all["diff"] = names(diff_rows);
    all["measure"] = names(measure_rows);
    all["wall"] = names(wall_rows);
    all["face"] = names(face_rows);
    all["clear"] = names(clear_rows);
    all["slice"] = names(slice_rows);
    module.attr("option_names") = all;
}
