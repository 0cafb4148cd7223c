/* SPDX-License-Identifier: MIT
 * Scenes: text in, what is known of them, their exact field at arrays of points, text out.
 */
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "module/objects.h"
#include "module/options.h"

namespace
{

struct Text {
    std::string text;
    bool is_whole = true; /* memory was enough for all of it */
};

/* Called from C, through which nothing may be thrown. */
void append_text(void *user, const char *text, size_t length)
{
    auto *to = static_cast<Text *>(user);
    try {
        to->text.append(text, length);
    } catch (const std::exception &) {
        to->is_whole = false;
    }
}

/* Its own before the work begins, so that the scene is freed if a callback of Python raises. */
std::unique_ptr<Scene> scene_of(const Run &run)
{
    auto out = std::make_unique<Scene>();
    out->context = run.context;
    return out;
}

nb::tuple scene_result(csgm_status status, std::unique_ptr<Scene> out)
{
    return result_of(status, status == CSGM_OK && out->scene /* none where it is only checked */
                                 ? nb::cast(out.release(), nb::rv_policy::take_ownership)
                                 : nb::none());
}

nb::tuple load(const Run &run, nb::bytes path, nb::dict given)
{
    Keep keep;
    auto out = scene_of(run);
    csgm_scene_options options = csgm_scene_options_default();
    fill_scene_options(options, given, keep);
    const char *name = keep.text(path, "path");
    csgm_status status = run.work([&] {
        csgm_scene *scene = nullptr;
        csgm_status loaded = csgm_scene_load(run.context->get(), name, &options, &scene);
        out->scene.reset(scene);
        return loaded;
    });
    return scene_result(status, std::move(out));
}

nb::tuple parse(const Run &run, nb::bytes text, nb::bytes name, nb::dict given)
{
    Keep keep;
    auto out = scene_of(run);
    csgm_scene_options options = csgm_scene_options_default();
    fill_scene_options(options, given, keep);
    const char *path = keep.text(name, "name");
    csgm_status status = run.work([&] {
        csgm_scene *scene = nullptr;
        csgm_status parsed =
            csgm_scene_parse(run.context->get(), text.c_str(), text.size(), path, &options, &scene);
        out->scene.reset(scene);
        return parsed;
    });
    return scene_result(status, std::move(out));
}

nb::dict info(const Scene &self)
{
    csgm_scene_info known = csgm_scene_get_info(self.scene.get());
    nb::dict out;
    out["bounds"] = box_of(known.bounds);
    out["primitive_count"] = known.primitive_count;
    out["operator_count"] = known.operator_count;
    out["lipschitz"] = known.lipschitz;
    out["has_colors"] = known.has_colors;
    out["parse_s"] = known.parse_s;
    out["evaluate_s"] = known.evaluate_s;
    return out;
}

nb::list files(const Scene &self)
{
    nb::list out;
    for (size_t i = 0; const char *path = csgm_scene_dependency(self.scene.get(), i); i++)
        out.append(nb::bytes(path));
    return out;
}

/* The arrays belong to the caller, and are of equal length: Python's side has made them. */
nb::tuple eval_points(const Run &run, const Scene &self, Rows3<const double> points,
                      nb::ndarray<double, nb::shape<-1>, nb::c_contig> values,
                      std::optional<Rows3<double>> gradients)
{
    double *into = gradients ? gradients->data() : nullptr;
    csgm_status status = run.work([&] {
        return csgm_scene_eval_points(run.context->get(), self.scene.get(), points.data(),
                                      points.shape(0), values.data(), into);
    });
    return result_of(status, nb::none());
}

nb::tuple dump(const Run &run, const Scene &self, int what)
{
    Text out;
    csgm_status status = run.work([&] {
        csgm_status dumped = csgm_scene_dump(run.context->get(), self.scene.get(), (csgm_dump)what,
                                             append_text, &out);
        return dumped == CSGM_OK && !out.is_whole ? CSGM_ERR_MEMORY : dumped;
    });
    return result_of(status, text_of(out.text.c_str()));
}

nb::tuple draw(const Run &run, const Scene &self, nb::bytes path, nb::dict given)
{
    Keep keep;
    csgm_write_options options = csgm_write_options_default();
    fill_write_options(options, given, keep);
    const char *name = keep.text(path, "path");
    csgm_drawing_format format = csgm_drawing_format_from_path(name);
    csgm_status status = run.work([&] {
        return csgm_scene_draw(run.context->get(), self.scene.get(), name, format, &options);
    });
    return result_of(status, nb::none());
}

} // namespace

void define_scenes(nb::module_ &module)
{
    nb::class_<Scene>(module, "Scene")
        .def("info", info)
        .def("files", files)
        .def_prop_ro("layer_count",
                     [](const Scene &self) { return csgm_scene_layer_count(self.scene.get()); });
    module.def("load", load, nb::arg("run"), nb::arg("path"), nb::arg("options"));
    module.def("parse", parse, nb::arg("run"), nb::arg("text"), nb::arg("name"),
               nb::arg("options"));
    module.def("eval_points", eval_points, nb::arg("run"), nb::arg("scene"),
               nb::arg("points").noconvert(), nb::arg("values").noconvert(),
               nb::arg("gradients").noconvert().none());
    module.def("dump", dump, nb::arg("run"), nb::arg("scene"), nb::arg("what"));
    module.def("draw", draw, nb::arg("run"), nb::arg("scene"), nb::arg("path"), nb::arg("options"));
    module.def("quality_tolerance", [](int quality, const Scene &scene) {
        return csgm_quality_tolerance((csgm_quality)quality,
                                      csgm_scene_get_info(scene.scene.get()).bounds);
    });
    module.def("drawing_format", [](nb::bytes path) {
        return csgm_drawing_format_name(csgm_drawing_format_from_path(path.c_str()));
    });
}
