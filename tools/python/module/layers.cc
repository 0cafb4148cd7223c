/* SPDX-License-Identifier: MIT
 * Layers for printers: straight into a file.
 */
#include <nanobind/stl/string.h>

#include "csgmesh/slicing.h"
#include "module/objects.h"
#include "module/options.h"

namespace
{

nb::list layer_formats()
{
    nb::list out;
    for (int i = CSGM_LAYERS_NONE + 1; i < CSGM_LAYERS_COUNT; i++)
        if (csgm_layers_format_available((csgm_layers_format)i))
            out.append(csgm_layers_format_name((csgm_layers_format)i));
    return out;
}

nb::dict dict_of(const csgm_slice_stats &s)
{
    nb::dict out;
    out["layers"] = s.layers;
    out["contours"] = s.contours;
    out["points"] = s.points;
    out["unsettled"] = s.unsettled;
    out["smallest"] = s.smallest;
    out["tolerance"] = s.tolerance;
    out["volume"] = s.volume;
    out["lowest"] = s.lowest;
    out["highest"] = s.highest;
    out["sampled"] = s.sampled;
    out["sampled_edge"] = s.sampled_edge;
    return out;
}

/* format: "" is that of the path. */
nb::tuple slice_scene(const Run &run, const Scene &scene, nb::bytes path, nb::bytes format,
                      nb::dict given)
{
    Keep keep;
    const char *name = keep.text(path, "path"), *named = keep.text(format, "format");
    csgm_slice_options options = csgm_slice_options_default();
    options.monitor = run.context->monitor();
    fill_slice_options(options, given, keep);
    csgm_layers_format as =
        *named ? csgm_layers_format_from_name(named) : csgm_layers_format_from_path(name);
    csgm_slice_stats stats = csgm_slice_stats_default();
    csgm_status status = run.work([&] {
        csgm_field *field = nullptr;
        csgm_status made = csgm_field_compile(run.context->get(), scene.scene.get(), &field);
        FieldPointer owner{field, csgm_field_destroy};
        return made != CSGM_OK
                   ? made
                   : csgm_slice_field(run.context->get(), field, name, as, &options, &stats);
    });
    return result_of(status, dict_of(stats));
}

} // namespace

void define_layers(nb::module_ &module)
{
    module.def("layer_formats", layer_formats);
    module.def("slice_scene", slice_scene, nb::arg("run"), nb::arg("scene"), nb::arg("path"),
               nb::arg("format"), nb::arg("options"));
}
