/* SPDX-License-Identifier: MIT
 * Pictures as arrays of rows, columns and four channels.
 */
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "module/objects.h"
#include "module/options.h"

namespace
{

using Pixels = nb::ndarray<const uint8_t, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>;

/* Its own before the work begins, so that the image is freed if a callback of Python raises. */
std::unique_ptr<Image> image_of(const Run &run)
{
    auto out = std::make_unique<Image>();
    out->context = run.context;
    return out;
}

nb::tuple image_result(csgm_status status, std::unique_ptr<Image> out)
{
    if (status != CSGM_OK)
        return result_of(status, nb::none());
    return result_of(status, nb::cast(out.release(), nb::rv_policy::take_ownership));
}

csgm_render_options options_of(const Run &run, nb::dict given, Keep &keep)
{
    csgm_render_options options = csgm_render_options_default();
    options.monitor = run.context->monitor();
    fill_render_options(options, given, keep);
    return options;
}

nb::tuple render_scene(const Run &run, const Scene &scene, nb::dict given)
{
    Keep keep;
    auto out = image_of(run);
    csgm_render_options options = options_of(run, given, keep);
    csgm_status status = run.work([&] {
        csgm_field *field = nullptr;
        csgm_image *image = nullptr;
        csgm_status made = csgm_field_compile(run.context->get(), scene.scene.get(), &field);
        FieldPointer owner{field, csgm_field_destroy};
        if (made == CSGM_OK)
            made = csgm_render_scene(run.context->get(), field, &options, &image, nullptr);
        out->image.reset(image);
        return made;
    });
    return image_result(status, std::move(out));
}

nb::tuple render_mesh(const Run &run, const Mesh &mesh, nb::dict given)
{
    Keep keep;
    auto out = image_of(run);
    csgm_render_options options = options_of(run, given, keep);
    csgm_status status = run.work([&] {
        csgm_image *image = nullptr;
        csgm_status made =
            csgm_render_mesh(run.context->get(), &mesh.view, &options, &image, nullptr);
        out->image.reset(image);
        return made;
    });
    return image_result(status, std::move(out));
}

nb::object pixels_of(nb::handle self)
{
    csgm_image_view view = csgm_image_get_view(nb::cast<const Image &>(self).image.get());
    return nb::cast(nb::ndarray<nb::numpy, const uint8_t, nb::ndim<3>, nb::c_contig>(
        view.pixels, {view.height, view.width, 4}, self));
}

nb::tuple write_image(const Run &run, Pixels pixels, nb::bytes path)
{
    Keep keep;
    const char *name = keep.text(path, "path");
    csgm_image_view view{(uint32_t)pixels.shape(1), (uint32_t)pixels.shape(0), pixels.data()};
    csgm_status status = run.work([&] {
        csgm_image *image = nullptr;
        csgm_status made = csgm_image_create(run.context->get(), &view, &image);
        if (made == CSGM_OK)
            made = csgm_image_write(run.context->get(), image, name, CSGM_IMAGE_AUTO);
        csgm_image_destroy(image);
        return made;
    });
    return result_of(status, nb::none());
}

} // namespace

void define_pictures(nb::module_ &module)
{
    nb::class_<Image>(module, "Image").def_prop_ro("pixels", pixels_of);
    module.def("render_scene", render_scene, nb::arg("run"), nb::arg("scene"), nb::arg("options"));
    module.def("render_mesh", render_mesh, nb::arg("run"), nb::arg("mesh"), nb::arg("options"));
    module.def("write_image", write_image, nb::arg("run"), nb::arg("pixels").noconvert(),
               nb::arg("path"));
}
