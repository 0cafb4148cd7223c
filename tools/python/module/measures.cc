/* SPDX-License-Identifier: MIT
 * Numbers with proof: what a scene or a mesh measures, and whether parts stay clear of each other.
 * Intervals are pairs, (low, high).
 */
#include <nanobind/stl/string.h>

#include "csgmesh/clearance.h"
#include "csgmesh/fabrication.h"
#include "module/objects.h"
#include "module/options.h"

namespace
{

nb::tuple pair_of(const csgm_interval &interval)
{
    return nb::make_tuple(interval.low, interval.high);
}

template <size_t COUNT> nb::tuple pairs_of(const csgm_interval (&intervals)[COUNT])
{
    nb::list out;
    for (const csgm_interval &interval : intervals)
        out.append(pair_of(interval));
    return nb::tuple(out);
}

/* ---- measures ---------------------------------------------------------------------------------- */

nb::dict dict_of(const csgm_measures &m)
{
    nb::dict out;
    nb::list axes, within;
    for (int n = 0; n < 3; n++) {
        axes.append(vector_of(m.axes[n]));
        within.append(m.axis_within[n]);
    }
    out["is_reached"] = m.is_reached;
    out["cubes"] = m.cubes;
    out["volume"] = pair_of(m.volume);
    out["mass"] = pair_of(m.mass);
    out["area"] = pair_of(m.area);
    out["centroid"] = pairs_of(m.centroid);
    out["inertia"] = pairs_of(m.inertia);
    out["moments"] = pairs_of(m.moments);
    out["axes"] = nb::tuple(axes);
    out["axis_within"] = nb::tuple(within);
    out["bounds"] = pairs_of(m.bounds);
    return out;
}

/* what: measures with the options, without the GIL. */
template <typename What> nb::tuple measure(const Run &run, nb::dict given, What what)
{
    Keep keep;
    csgm_measure_options options = csgm_measure_options_default();
    options.monitor = run.context->monitor();
    fill_measure_options(options, given, keep);
    csgm_measures measures = csgm_measures_default();
    csgm_status status = run.work([&] { return what(options, measures); });
    return result_of(status, dict_of(measures));
}

nb::tuple measure_scene(const Run &run, const Scene &scene, nb::dict given)
{
    return measure(run, given, [&](const csgm_measure_options &options, csgm_measures &out) {
        csgm_field *field = nullptr;
        csgm_status status = csgm_field_compile(run.context->get(), scene.scene.get(), &field);
        FieldPointer owner{field, csgm_field_destroy};
        return status != CSGM_OK ? status
                                 : csgm_measure_field(run.context->get(), field, &options, &out);
    });
}

nb::tuple measure_mesh(const Run &run, const Mesh &mesh, nb::dict given)
{
    return measure(run, given, [&](const csgm_measure_options &options, csgm_measures &out) {
        return csgm_measure_mesh(run.context->get(), &mesh.view, &options, &out);
    });
}

/* ---- what a workshop asks ------------------------------------------------------------------------ */

/* Compiles the scene and hands the field on. */
template <typename What> csgm_status with_field(const Run &run, const Scene &scene, What what)
{
    return run.work([&] {
        csgm_field *field = nullptr;
        csgm_status status = csgm_field_compile(run.context->get(), scene.scene.get(), &field);
        FieldPointer owner{field, csgm_field_destroy};
        return status != CSGM_OK ? status : what(field);
    });
}

nb::dict dict_of(const csgm_oriented_box &box)
{
    nb::dict out;
    nb::list axes;
    for (const csgm_vec3 &axis : box.axes)
        axes.append(vector_of(axis));
    out["is_reached"] = box.is_reached;
    out["cubes"] = box.cubes;
    out["volume"] = pair_of(box.volume);
    out["edges"] = pairs_of(box.edges);
    out["axes"] = nb::tuple(axes);
    out["ends"] = pairs_of(box.ends);
    return out;
}

nb::dict dict_of(const csgm_span &span)
{
    nb::dict out;
    out["length"] = pair_of(span.length);
    out["overlooked"] = span.overlooked;
    out["at"] = span.is_shown
                    ? nb::object(nb::make_tuple(vector_of(span.at[0]), vector_of(span.at[1])))
                    : nb::none();
    return out;
}

csgm_measure_options measure_options_of(const Run &run, nb::dict given, Keep &keep)
{
    csgm_measure_options options = csgm_measure_options_default();
    options.monitor = run.context->monitor();
    fill_measure_options(options, given, keep);
    return options;
}

nb::tuple oriented_box_of_scene(const Run &run, const Scene &scene, nb::dict given)
{
    Keep keep;
    csgm_measure_options options = measure_options_of(run, given, keep);
    csgm_oriented_box box = csgm_oriented_box_default();
    csgm_status status = with_field(run, scene, [&](const csgm_field *field) {
        return csgm_oriented_box_of_field(run.context->get(), field, &options, &box);
    });
    return result_of(status, dict_of(box));
}

nb::tuple oriented_box_of_mesh(const Run &run, const Mesh &mesh, nb::dict given)
{
    Keep keep;
    csgm_measure_options options = measure_options_of(run, given, keep);
    csgm_oriented_box box = csgm_oriented_box_default();
    csgm_status status = run.work(
        [&] { return csgm_oriented_box_of_mesh(run.context->get(), &mesh.view, &options, &box); });
    return result_of(status, dict_of(box));
}

nb::tuple walls_of_scene(const Run &run, const Scene &scene, nb::dict given)
{
    Keep keep;
    csgm_wall_options options = csgm_wall_options_default();
    options.monitor = run.context->monitor();
    fill_wall_options(options, given, keep);
    csgm_walls walls = csgm_walls_default();
    csgm_status status = with_field(run, scene, [&](const csgm_field *field) {
        return csgm_walls_of_field(run.context->get(), field, &options, &walls);
    });
    nb::dict out;
    out["is_reached"] = walls.is_reached;
    out["pairs"] = walls.pairs;
    out["wall"] = dict_of(walls.wall);
    out["gap"] = dict_of(walls.gap);
    return result_of(status, out);
}

nb::tuple faces_of_mesh(const Run &run, const Mesh &mesh, nb::dict given)
{
    Keep keep;
    csgm_face_options options = csgm_face_options_default();
    fill_face_options(options, given, keep);
    csgm_faces faces = csgm_faces_default();
    csgm_status status = run.work(
        [&] { return csgm_faces_of_mesh(run.context->get(), &mesh.view, &options, &faces); });
    nb::dict out;
    out["area"] = pair_of(faces.area);
    out["overhang"] = pair_of(faces.overhang);
    out["resting"] = pair_of(faces.resting);
    out["steep"] = pair_of(faces.steep);
    out["overhang_triangles"] = faces.overhang_triangles;
    out["steep_triangles"] = faces.steep_triangles;
    return result_of(status, out);
}

/* ---- clearances -------------------------------------------------------------------------------- */

struct Clearances {
    ContextPointer context;
    std::unique_ptr<csgm_clearances, decltype(&csgm_clearances_destroy)> clearances{
        nullptr, csgm_clearances_destroy};
};

/* Scenes that are added must have been read in the same run. */
nb::tuple begin_clear(const Run &run, nb::dict given)
{
    Keep keep;
    auto out = std::make_unique<Clearances>();
    csgm_clear_options options = csgm_clear_options_default();
    options.monitor = run.context->monitor();
    fill_clear_options(options, given, keep);
    csgm_clearances *made = nullptr;
    csgm_status status = csgm_clearances_create(run.context->get(), &options, &made);
    out->context = run.context;
    out->clearances.reset(made);
    return result_of(status, nb::cast(out.release(), nb::rv_policy::take_ownership));
}

nb::tuple add_pose(const Run &run, const Clearances &self, const Scene &scene)
{
    csgm_status status =
        run.work([&] { return csgm_clearances_add(self.clearances.get(), scene.scene.get()); });
    return result_of(status, nb::none());
}

nb::dict clear_pair_of(const csgm_clear_pair &p)
{
    static const char *const states[] = {"apart", "touching", "undecided", "interfering"};
    bool knows_nearest =
        !p.by_boxes && (p.state == CSGM_CLEAR_APART || p.state == CSGM_CLEAR_TOUCHING);
    bool interferes = p.state == CSGM_CLEAR_INTERFERING;
    nb::dict out;
    out["parts"] = nb::make_tuple(text_of(p.names[0]), text_of(p.names[1]));
    out["state"] = states[p.state];
    out["pose"] = p.pose;
    out["gap"] = pair_of(p.gap);
    out["nearest"] =
        knows_nearest ? nb::object(nb::make_tuple(vector_of(p.nearest[0]), vector_of(p.nearest[1])))
                      : nb::none();
    out["inside"] = interferes ? nb::object(vector_of(p.inside)) : nb::none();
    out["volume"] = interferes ? nb::object(pair_of(p.volume)) : nb::none();
    out["size"] = p.state == CSGM_CLEAR_UNDECIDED ? nb::object(nb::float_(p.size)) : nb::none();
    out["poses"] = p.poses;
    out["poses_bad"] = p.poses_bad;
    out["poses_open"] = p.poses_open;
    out["steps"] = p.steps;
    out["steps_open"] = p.steps_open;
    out["first_open"] = p.steps_open ? nb::object(nb::int_(p.first_open)) : nb::none();
    out["gap_between"] = p.gap_between;
    return out;
}

nb::list clear_pairs_of(const Clearances &self)
{
    nb::list out;
    for (size_t i = 0; const csgm_clear_pair *pair = csgm_clearances_get(self.clearances.get(), i);
         i++)
        out.append(clear_pair_of(*pair));
    return out;
}

nb::list part_names_of(const Clearances &self)
{
    nb::list out;
    const char *name;
    for (size_t i = 0; csgm_clearances_part(self.clearances.get(), i, &name); i++)
        out.append(text_of(name));
    return out;
}

} // namespace

void define_measures(nb::module_ &module)
{
    nb::class_<Clearances>(module, "Clearances")
        .def("pairs", clear_pairs_of)
        .def("parts", part_names_of)
        .def_prop_ro("tolerance", [](const Clearances &self) {
            return csgm_clearances_tolerance(self.clearances.get());
        });
    module.def("measure_scene", measure_scene, nb::arg("run"), nb::arg("scene"),
               nb::arg("options"));
    module.def("measure_mesh", measure_mesh, nb::arg("run"), nb::arg("mesh"), nb::arg("options"));
    module.def("oriented_box_of_scene", oriented_box_of_scene, nb::arg("run"), nb::arg("scene"),
               nb::arg("options"));
    module.def("oriented_box_of_mesh", oriented_box_of_mesh, nb::arg("run"), nb::arg("mesh"),
               nb::arg("options"));
    module.def("walls_of_scene", walls_of_scene, nb::arg("run"), nb::arg("scene"),
               nb::arg("options"));
    module.def("faces_of_mesh", faces_of_mesh, nb::arg("run"), nb::arg("mesh"), nb::arg("options"));
    module.def("begin_clear", begin_clear, nb::arg("run"), nb::arg("options"));
    module.def("add_pose", add_pose, nb::arg("run"), nb::arg("clearances"), nb::arg("scene"));
}
