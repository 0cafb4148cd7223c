/* SPDX-License-Identifier: MIT
 * Any bytes -> the reader of DXF.
 */
#include "fuzz/fuzz_reader.h"
#include "outline/dxf/dxf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csg_outline outline;
    csg_dxf_report report;
    csg_dxf_request request = {
        .text = (const char *)data, .length = size, .tolerance = 0.1, .center = size & 1};
    fuzz_context_init(&context);
    csgm_status status = csg_dxf_outline(&context.memory, &request, &outline, &report);
    fuzz_expect_sentence(status, &report.problem);
    fuzz_expect_outline(status, &outline);
    csg_outline_release(&outline);
    fuzz_context_close(&context);
    return 0;
}
