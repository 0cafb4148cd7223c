/* SPDX-License-Identifier: MIT
 * Comparisons: the report as dicts, with the names that `csgmesh diff --json` uses, and the
 * distance of each vertex without a copy.
 */
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "module/objects.h"
#include "module/options.h"

namespace
{

nb::tuple compare(const Run &run, nb::object a, nb::object b, nb::object scene_a,
                  nb::object scene_b, nb::dict given)
{
    Keep keep;
    auto out = std::make_unique<Diff>(); /* frees the comparison if a callback of Python raises */
    out->context = run.context;
    csgm_diff_options options = csgm_diff_options_default();
    options.monitor = run.context->monitor();
    fill_diff_options(options, given, keep);
    const csgm_mesh_view &left = nb::cast<const Mesh &>(a).view;
    const csgm_mesh_view &right = nb::cast<const Mesh &>(b).view;
    if (!scene_a.is_none())
        options.scene_a = nb::cast<const Scene &>(scene_a).scene.get();
    if (!scene_b.is_none())
        options.scene_b = nb::cast<const Scene &>(scene_b).scene.get();
    csgm_status status = run.work([&] {
        csgm_diff *diff = nullptr;
        csgm_status made = csgm_diff_meshes(run.context->get(), &left, &right, &options, &diff);
        out->diff.reset(diff);
        return made;
    });
    if (status != CSGM_OK)
        return result_of(status, nb::none());
    out->a = a;
    out->b = b;
    return result_of(status, nb::cast(out.release(), nb::rv_policy::take_ownership));
}

/* ---- the report -------------------------------------------------------------------------------- */

nb::dict figures_of(const csgm_diff_figures &f)
{
    nb::dict out = check_of(f.check);
    out["vertices"] = f.vertices;
    out["triangles"] = f.triangles;
    out["closed"] = f.is_closed;
    out["parts"] = f.parts;
    out["normals"] = f.has_normals;
    out["colors"] = f.has_colors;
    return out;
}

nb::object distance_of(const csgm_diff_distance &d)
{
    nb::dict out;
    nb::list worst;
    if (!d.is_measured)
        return nb::none();
    for (uint32_t i = 0; i < d.worst_count; i++) {
        nb::dict place;
        place["at"] = vector_of(d.worst[i].at);
        place["nearest"] = vector_of(d.worst[i].nearest);
        place["distance"] = d.worst[i].distance;
        worst.append(place);
    }
    out["max_lower"] = d.lower;
    out["max_upper"] = d.upper;
    out["refined"] = d.is_refined;
    if (d.is_sampled) {
        out["mean"] = d.mean;
        out["rms"] = d.rms;
        out["p95"] = d.percentile_95;
        out["p99"] = d.percentile_99;
    }
    out["worst"] = worst;
    return out;
}

nb::object volume_of(const csgm_diff_volume &v)
{
    nb::dict out;
    if (!v.is_measured)
        return nb::none();
    out["only_a"] = v.only_a;
    out["only_b"] = v.only_b;
    out["both"] = v.both;
    out["ratio"] = v.ratio;
    out["accuracy"] = v.accuracy;
    return out;
}

nb::object field_of(const csgm_diff_field &f)
{
    nb::dict out;
    if (!f.is_measured)
        return nb::none();
    out["lambda"] = f.lipschitz;
    out["max_abs_field"] = f.max_abs_field;
    out["at"] = vector_of(f.at);
    out["mean_abs_field"] = f.mean_abs_field;
    out["distance_lower"] = f.lower;
    out["distance_upper"] = f.upper;
    out["evaluations"] = f.evaluations;
    return out;
}

nb::object attribute_of(const csgm_diff_attribute &a)
{
    nb::dict out;
    if (!a.is_compared)
        return nb::none();
    out["largest"] = a.largest;
    out["share"] = a.share;
    return out;
}

nb::list reasons_of(uint32_t reasons)
{
    static const char *const names[] = {"distance", "volume", "topology", "normals",
                                        "colors",   "names",  "empty"};
    nb::list out;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (reasons & 1u << i)
            out.append(names[i]);
    return out;
}

nb::dict report_of(const Diff &self)
{
    static const char *const levels[] = {"different", "within tolerance", "same triangles",
                                         "same bytes"};
    const csgm_diff_report &r = *csgm_diff_get_report(self.diff.get());
    nb::dict out;
    out["level"] = levels[r.level];
    out["different"] = r.is_different;
    out["reasons"] = reasons_of(r.reasons);
    out["tolerance"] = r.tolerance;
    out["precision"] = r.precision;
    out["turned"] = r.is_turned;
    out["a"] = figures_of(r.figures[0]);
    out["b"] = figures_of(r.figures[1]);
    out["hausdorff"] = nb::make_tuple(r.hausdorff_lower, r.hausdorff_upper);
    out["a_to_b"] = distance_of(r.distance[0]);
    out["b_to_a"] = distance_of(r.distance[1]);
    out["counted"] = distance_of(r.counted);
    out["volume"] = volume_of(r.volume);
    out["a_to_field_of_b"] = field_of(r.field[0]);
    out["b_to_field_of_a"] = field_of(r.field[1]);
    out["normals"] = attribute_of(r.normals);
    out["colors"] = attribute_of(r.colors);
    out["names"] = attribute_of(r.names);
    return out;
}

nb::object distances_of(nb::handle self, int side)
{
    const Diff &diff = nb::cast<const Diff &>(self);
    const float *distances = csgm_diff_vertex_distances(diff.diff.get(), side);
    const csgm_mesh_view &view = nb::cast<const Mesh &>(side ? diff.b : diff.a).view;
    if (!distances)
        return nb::none();
    return nb::cast(nb::ndarray<nb::numpy, const float, nb::ndim<1>, nb::c_contig>(
        distances, {(size_t)view.vertex_count}, self));
}

nb::tuple write_heatmap(const Run &run, const Diff &self, int side, nb::bytes path, nb::dict given)
{
    Keep keep;
    csgm_write_options options = csgm_write_options_default();
    fill_write_options(options, given, keep);
    const char *name = keep.text(path, "path");
    csgm_status status = run.work([&] {
        return csgm_diff_write_heatmap(run.context->get(), self.diff.get(), side, name,
                                       CSGM_FORMAT_AUTO, &options);
    });
    return result_of(status, nb::none());
}

} // namespace

nb::dict check_of(const csgm_mesh_check &check)
{
    nb::dict out;
#define PUT(name) out[#name] = check.name
    PUT(boundary_edges);
    PUT(nonmanifold_edges);
    PUT(misoriented_edges);
    PUT(nonmanifold_vertices);
    PUT(degenerate_triangles);
    PUT(index_out_of_range);
    PUT(unused_vertices);
    PUT(zero_area_triangles);
    PUT(euler);
    PUT(components);
    PUT(genus);
    PUT(area);
    PUT(volume);
    PUT(min_angle_deg);
    PUT(max_aspect);
#undef PUT
    out["bounds"] = box_of(check.bounds);
    return out;
}

void define_diffs(nb::module_ &module)
{
    nb::class_<Diff>(module, "Diff")
        .def("report", report_of)
        .def("distances", [](nb::handle self, int side) { return distances_of(self, side); });
    module.def("diff", compare, nb::arg("run"), nb::arg("a"), nb::arg("b"),
               nb::arg("scene_a").none(), nb::arg("scene_b").none(), nb::arg("options"));
    module.def("write_heatmap", write_heatmap, nb::arg("run"), nb::arg("diff"), nb::arg("side"),
               nb::arg("path"), nb::arg("options"));
}
