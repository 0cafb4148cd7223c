/* SPDX-License-Identifier: MIT
 * Meshes: made of scenes, read from files or of arrays of the caller; their arrays without a copy.
 */
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "module/objects.h"
#include "module/options.h"

namespace
{

template <typename Number>
using Shown = nb::ndarray<nb::numpy, const Number, nb::ndim<2>, nb::c_contig>;

/* An array of `width` columns that keeps the mesh alive; None where the mesh has none. */
template <typename Number>
nb::object show(nb::handle self, const Number *data, uint64_t rows, size_t width)
{
    static const Number nothing[1] = {};
    if (!data && rows > 0)
        return nb::none();
    return nb::cast(Shown<Number>(data ? data : nothing, {(size_t)rows, width}, self));
}

const csgm_mesh_view &view_of(nb::handle self)
{
    return nb::cast<const Mesh &>(self).view;
}

/* ---- building ---------------------------------------------------------------------------------- */

nb::dict stats_of(const csgm_mesh_stats &s)
{
    nb::dict out;
    out["cells"] = nb::make_tuple(s.cells[0], s.cells[1], s.cells[2]);
#define PUT(name) out[#name] = s.name
    PUT(octree_s);
    PUT(mesh_s);
    PUT(reshape_s);
    PUT(cell_size);
    PUT(cell_coarsest);
    PUT(tolerance);
    PUT(cells_visited);
    PUT(pruned_outside);
    PUT(pruned_inside);
    PUT(leaf_blocks);
    PUT(point_evaluations);
    PUT(gradient_evaluations);
    PUT(interval_evaluations);
    PUT(primitive_evaluations);
    PUT(mean_tape_length);
    PUT(memory_peak_bytes);
    PUT(feature_vertices);
    PUT(smooth_features);
    PUT(fading_features);
    PUT(triangles_before);
    PUT(own_triangles);
    PUT(own_triangles_before);
    PUT(is_measured);
    PUT(distance_allowed);
    PUT(max_distance_bound);
    PUT(max_distance_measured);
    PUT(open_places);
    PUT(unresolved_cells);
#undef PUT
    return out;
}

nb::dict certificate_of(const csgm_certify &c)
{
    nb::dict out;
    nb::list places;
    for (uint32_t i = 0; i < c.place_count; i++) {
        const csgm_certify_place &p = c.places[i];
        nb::dict place;
        place["is_missed"] = p.is_missed;
        place["is_gap"] = p.is_gap;
        place["at"] = vector_of(p.at);
        place["thickness"] = p.thickness;
        place["cell_size"] = p.cell_size;
        place["cells"] = p.cells;
        place["file"] = text_of(p.source_name);
        place["line"] = p.line;
        place["column"] = p.column;
        places.append(place);
    }
    out["certified"] = c.certified;
    out["crease"] = c.crease;
    out["refined"] = c.refined;
    out["unresolved"] = c.unresolved;
    out["missed"] = c.missed;
    out["thickness"] = c.thickness;
    out["places"] = places;
    out["places_more"] = c.places_more;
    return out;
}

nb::dict all_stats_of(const csgm_mesh_stats &stats)
{
    nb::dict out = stats_of(stats);
    out["certify"] = stats.certify.is_done ? nb::object(certificate_of(stats.certify)) : nb::none();
    return out;
}

/* Its own before the work begins, so that the mesh is freed if a callback of Python raises. */
std::unique_ptr<Mesh> mesh_of(const Run &run)
{
    auto out = std::make_unique<Mesh>();
    out->context = run.context;
    return out;
}

nb::tuple mesh_result(csgm_status status, std::unique_ptr<Mesh> out, nb::object stats)
{
    if (status != CSGM_OK)
        return result_of(status, nb::none());
    out->view = csgm_mesh_get_view(out->mesh.get());
    out->stats = stats;
    return result_of(status, nb::cast(out.release(), nb::rv_policy::take_ownership));
}

csgm_mesh_options options_of(const Run &run, nb::dict given, Keep &keep)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    options.monitor = run.context->monitor();
    fill_mesh_options(options, given, keep);
    return options;
}

csgm_status compile(const Run &run, const Scene &scene, FieldPointer &field)
{
    csgm_field *made = nullptr;
    csgm_status status = csgm_field_compile(run.context->get(), scene.scene.get(), &made);
    field.reset(made);
    return status;
}

nb::tuple build(const Run &run, const Scene &scene, nb::dict given)
{
    Keep keep;
    auto out = mesh_of(run);
    csgm_mesh_options options = options_of(run, given, keep);
    csgm_mesh_stats stats = csgm_mesh_stats_default();
    csgm_status status = run.work([&] {
        FieldPointer field{nullptr, csgm_field_destroy};
        csgm_mesh *mesh = nullptr;
        csgm_status made = compile(run, scene, field);
        if (made == CSGM_OK)
            made = csgm_mesh_build(run.context->get(), field.get(), &options, &mesh, &stats);
        out->mesh.reset(mesh);
        return made;
    });
    return mesh_result(status, std::move(out), all_stats_of(stats));
}

/* (status, (vertices, triangles, stats)). */
nb::tuple build_file(const Run &run, const Scene &scene, nb::bytes path, nb::bytes format,
                     nb::dict given, nb::dict write_given)
{
    Keep keep;
    csgm_mesh_options options = options_of(run, given, keep);
    csgm_write_options write_options = csgm_write_options_default();
    fill_write_options(write_options, write_given, keep);
    csgm_mesh_stats stats = csgm_mesh_stats_default();
    uint64_t counts[2] = {};
    const char *name = keep.text(path, "path");
    csgm_format as = csgm_format_from_name(keep.text(format, "format"));
    csgm_status status = run.work([&] {
        FieldPointer field{nullptr, csgm_field_destroy};
        csgm_status made = compile(run, scene, field);
        return made != CSGM_OK ? made
                               : csgm_mesh_build_file(run.context->get(), field.get(), &options,
                                                      name, as, &write_options, counts, &stats);
    });
    return result_of(status, nb::make_tuple(counts[0], counts[1], all_stats_of(stats)));
}

/* ---- files ------------------------------------------------------------------------------------- */

nb::tuple read_mesh(const Run &run, nb::bytes path, nb::bytes format)
{
    Keep keep;
    auto out = mesh_of(run);
    const char *name = keep.text(path, "path");
    csgm_format as = csgm_format_from_name(keep.text(format, "format"));
    csgm_status status = run.work([&] {
        csgm_mesh *mesh = nullptr;
        csgm_status read = csgm_mesh_read(run.context->get(), name, as, &mesh);
        out->mesh.reset(mesh);
        return read;
    });
    return mesh_result(status, std::move(out), nb::none());
}

nb::tuple write_mesh(const Run &run, const Mesh &self, nb::bytes path, nb::bytes format,
                     nb::dict given)
{
    Keep keep;
    csgm_write_options options = csgm_write_options_default();
    fill_write_options(options, given, keep);
    const char *name = keep.text(path, "path");
    csgm_format as = csgm_format_from_name(keep.text(format, "format"));
    csgm_status status = run.work(
        [&] { return csgm_mesh_write(run.context->get(), &self.view, name, as, &options); });
    return result_of(status, nb::none());
}

nb::tuple as_file(const Run &run, const Mesh &self, nb::bytes format, nb::dict given)
{
    Keep keep;
    auto out = mesh_of(run);
    csgm_write_options options = csgm_write_options_default();
    fill_write_options(options, given, keep);
    csgm_format as = csgm_format_from_name(keep.text(format, "format"));
    csgm_status status = run.work([&] {
        csgm_mesh *mesh = nullptr;
        csgm_status made = csgm_mesh_as_file(run.context->get(), &self.view, as, &options, &mesh);
        out->mesh.reset(mesh);
        return made;
    });
    return mesh_result(status, std::move(out), nb::none());
}

nb::tuple inspect(const Run &run, const Mesh &self)
{
    csgm_mesh_check check{};
    csgm_status status =
        run.work([&] { return csgm_mesh_inspect(run.context->get(), &self.view, &check); });
    return result_of(status, check_of(check));
}

/* (status, (clusters, size of a cell)); cluster_of has a number for each vertex. */
nb::tuple cluster(const Run &run, const Mesh &self, nb::tuple low, nb::tuple high, uint64_t most,
                  nb::ndarray<uint32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu> cluster_of)
{
    uint32_t count = 0;
    double cell_size = 0;
    auto at = [](nb::tuple point) {
        return csgm_vec3{nb::cast<double>(point[0]), nb::cast<double>(point[1]),
                         nb::cast<double>(point[2])};
    };
    csgm_box frame{at(low), at(high)};
    csgm_status status = run.work([&] {
        return csgm_mesh_cluster(run.context->get(), &self.view, frame, most, cluster_of.data(),
                                 &count, &cell_size);
    });
    return result_of(status, nb::make_tuple(count, cell_size));
}

/* ---- arrays of the caller ---------------------------------------------------------------------- */

using Positions = Rows3<const float>;
using Triangles = Rows3<const uint32_t>;
using Colors = nb::ndarray<const uint8_t, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;

void add_parts(Mesh &mesh, nb::list parts)
{
    for (nb::handle item : parts) {
        nb::tuple part = nb::cast<nb::tuple>(item);
        csgm_mesh_part made{nullptr, nb::cast<uint64_t>(part[1]), nb::cast<uint64_t>(part[2])};
        if (!part[0].is_none())
            made.name = mesh.names.emplace_back(nb::cast<std::string>(part[0])).c_str();
        mesh.parts.push_back(made);
    }
    mesh.view.parts = mesh.parts.empty() ? nullptr : mesh.parts.data();
    mesh.view.part_count = mesh.parts.size();
}

/* Lengths have been compared by then. */
std::unique_ptr<Mesh> of_arrays(csgm_vec3 origin, Positions positions, Triangles triangles,
                                std::optional<Positions> normals, std::optional<Colors> colors,
                                nb::list parts)
{
    auto mesh = std::make_unique<Mesh>();
    mesh->view.origin = origin;
    mesh->view.positions = positions.data();
    mesh->view.indices = triangles.data();
    mesh->view.vertex_count = positions.shape(0);
    mesh->view.triangle_count = triangles.shape(0);
    mesh->view.normals = normals ? normals->data() : nullptr;
    mesh->view.colors = colors ? colors->data() : nullptr;
    add_parts(*mesh, parts);
    return mesh;
}

Mesh *mesh_of_arrays(nb::tuple origin, nb::object positions, nb::object triangles,
                     nb::object normals, nb::object colors, nb::list parts)
{
    csgm_vec3 at{nb::cast<double>(origin[0]), nb::cast<double>(origin[1]),
                 nb::cast<double>(origin[2])};
    auto mesh =
        of_arrays(at, nb::cast<Positions>(positions, false), nb::cast<Triangles>(triangles, false),
                  nb::cast<std::optional<Positions>>(normals, false),
                  nb::cast<std::optional<Colors>>(colors, false), parts);
    mesh->arrays = {positions, triangles, normals, colors};
    return mesh.release();
}

nb::list parts_of(const Mesh &self)
{
    nb::list out;
    for (uint64_t i = 0; i < self.view.part_count; i++) {
        const csgm_mesh_part &part = self.view.parts[i];
        out.append(nb::make_tuple(text_of(part.name), part.first_triangle, part.triangle_count));
    }
    return out;
}

/* Of its context, with whatever else was made with that; none for arrays of the caller. */
uint64_t memory_of(const Mesh &self)
{
    return self.context ? csgm_context_memory(self.context->get(), nullptr) : 0;
}

} // namespace

void define_meshes(nb::module_ &module)
{
    nb::class_<Mesh>(module, "Mesh")
        .def_prop_ro("origin", [](const Mesh &self) { return vector_of(self.view.origin); })
        .def_prop_ro("positions",
                     [](nb::handle self) {
                         const csgm_mesh_view &view = view_of(self);
                         return show(self, view.positions, view.vertex_count, 3);
                     })
        .def_prop_ro("normals",
                     [](nb::handle self) {
                         const csgm_mesh_view &view = view_of(self);
                         return show(self, view.normals, view.vertex_count, 3);
                     })
        .def_prop_ro("colors",
                     [](nb::handle self) {
                         const csgm_mesh_view &view = view_of(self);
                         return show(self, view.colors, view.vertex_count, 4);
                     })
        .def_prop_ro("materials",
                     [](nb::handle self) {
                         const csgm_mesh_view &view = view_of(self);
                         return show(self, view.materials, view.vertex_count, 2);
                     })
        .def_prop_ro("triangles",
                     [](nb::handle self) {
                         const csgm_mesh_view &view = view_of(self);
                         return show(self, view.indices, view.triangle_count, 3);
                     })
        .def_prop_ro("parts", parts_of)
        .def_prop_ro("split", [](const Mesh &self) { return self.view.split; })
        .def_prop_ro("memory", memory_of)
        .def_ro("stats", &Mesh::stats);
    module.def("build", build, nb::arg("run"), nb::arg("scene"), nb::arg("options"));
    module.def("build_file", build_file, nb::arg("run"), nb::arg("scene"), nb::arg("path"),
               nb::arg("format"), nb::arg("options"), nb::arg("write_options"));
    module.def("read", read_mesh, nb::arg("run"), nb::arg("path"), nb::arg("format"));
    module.def("write", write_mesh, nb::arg("run"), nb::arg("mesh"), nb::arg("path"),
               nb::arg("format"), nb::arg("options"));
    module.def("as_file", as_file, nb::arg("run"), nb::arg("mesh"), nb::arg("format"),
               nb::arg("options"));
    module.def("inspect", inspect, nb::arg("run"), nb::arg("mesh"));
    module.def("cluster", cluster, nb::arg("run"), nb::arg("mesh"), nb::arg("low"), nb::arg("high"),
               nb::arg("most"), nb::arg("cluster_of").noconvert());
    module.def("mesh_of_arrays", mesh_of_arrays, nb::arg("origin"), nb::arg("positions"),
               nb::arg("triangles"), nb::arg("normals").none(), nb::arg("colors").none(),
               nb::arg("parts"));
}
