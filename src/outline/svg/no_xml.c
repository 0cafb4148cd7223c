/* SPDX-License-Identifier: MIT
 * Instead of xml.c where expat is missing.
 */
#include "outline/svg/xml.h"

csgm_status csg_xml_parse(csg_memory *memory, const char *text, size_t length, csg_xml *out,
                          csg_problem *problem)
{
    (void)memory, (void)text, (void)length, (void)out;
    return csg_problem_set(problem, CSGM_ERR_UNSUPPORTED,
                           "this build cannot read SVG files (made without expat)");
}
