/* SPDX-License-Identifier: MIT
 * The module csgmesh._core: libcsgmesh's public interface for Python, call by call. Calls that can
 * fail return (status, result); the package's Python files, which have the names that people use,
 * make exceptions of that and of the run's findings.
 */
#include <nanobind/stl/string.h>

#include <cstring>

#include "module/context.h"
#include "module/objects.h"
#include "module/options.h"

nb::tuple result_of(csgm_status status, nb::object object)
{
    return nb::make_tuple(csgm_status_name(status), status == CSGM_OK ? object : nb::none());
}

nb::tuple vector_of(const csgm_vec3 &v)
{
    return nb::make_tuple(v.x, v.y, v.z);
}

nb::tuple box_of(const csgm_box &box)
{
    return nb::make_tuple(vector_of(box.min), vector_of(box.max));
}

nb::object text_of(const char *text)
{
    if (!text)
        return nb::none();
    return nb::steal(PyUnicode_DecodeUTF8(text, (Py_ssize_t)strlen(text), "replace"));
}

static nb::dict traits_of(csgm_format format)
{
    uint32_t traits = csgm_format_traits(format);
    nb::dict out;
    out["name"] = csgm_format_name(format);
    out["title"] = csgm_format_title(format);
    out["is_written"] = csgm_format_available(format, false);
    out["is_read"] = csgm_format_available(format, true);
    out["keeps_normals"] = bool(traits & CSGM_KEEPS_NORMALS);
    out["keeps_creases"] = bool(traits & CSGM_KEEPS_CREASES);
    out["keeps_colors"] = bool(traits & CSGM_KEEPS_COLORS);
    out["keeps_names"] = bool(traits & CSGM_KEEPS_NAMES);
    out["keeps_materials"] = bool(traits & CSGM_KEEPS_MATERIALS);
    out["keeps_doubles"] = bool(traits & CSGM_KEEPS_DOUBLES);
    return out;
}

NB_MODULE(_core, module)
{
    module.attr("version") = csgm_version();
    module.attr("features") = csgm_build_features();
    module.def("format_of", [](nb::bytes path) {
        csgm_format format = csgm_format_from_path(path.c_str());
        return format == CSGM_FORMAT_AUTO ? "" : csgm_format_name(format);
    });
    module.def("formats", [] {
        nb::list out;
        for (int i = CSGM_FORMAT_AUTO + 1; i < CSGM_FORMAT_COUNT; i++)
            out.append(traits_of((csgm_format)i));
        return out;
    });
    define_options(module);
    define_context(module);
    define_scenes(module);
    define_meshes(module);
    define_pictures(module);
    define_diffs(module);
    define_measures(module);
    define_layers(module);
}
