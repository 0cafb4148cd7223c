/* SPDX-License-Identifier: MIT
 * What editors ask of texts, for the library's customers.
 */
#include "csgmesh/editing.h"
#include "lang/edit/format.h"

csgm_status csgm_scene_format(csgm_context *context, const char *text, size_t text_length,
                              const char *name, csgm_text_fn *sink, void *user)
{
    if (!context || (!text && text_length) || !sink)
        return CSGM_ERR_ARGUMENT;
    return csg_edit_format(context, text ? text : "", text_length, name ? name : "text", sink,
                           user);
}
