/* SPDX-License-Identifier: MIT
 * Where findings go: counted, capped, and handed to the user's callback. The codes are one table,
 * diagnostics.def. text/source.h turns a span into file, line and column and reports through this.
 */
#ifndef CSG_BASE_DIAGNOSTICS_H
#define CSG_BASE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

typedef enum csg_diag_code {
#define CSG_DIAG(name, number, severity, summary) CSG_DIAG_##name = (number),
#include "base/diagnostics.def"
#undef CSG_DIAG
} csg_diag_code;

enum { CSG_DIAG_MOST = 20 }; /* errors and warnings shown in one run, notes not counted */

typedef struct csg_diag_sink {
    csgm_diag_fn *on_diag; /* NULL = silent */
    void *user;
    bool warnings_as_errors;
    bool mute_notes;           /* the last finding was over the cap: drop its notes too */
    uint32_t errors, warnings; /* counted even above the cap */
    uint32_t dropped;          /* findings above the cap */
} csg_diag_sink;

/* Severity of the code's table row (warnings_as_errors not applied). */
csgm_severity csg_diag_severity(csg_diag_code code);
/* The table's one-line summary of a code, NULL for an unknown one. */
const char *csg_diag_summary(csg_diag_code code);

/* Fills severity and code, applies warnings_as_errors and the cap, counts, calls on_diag. */
void csg_diag_report(csg_diag_sink *sink, csg_diag_code code, csgm_diag diag);

/* Makes a message one line of whole characters, whatever the text of a scene put into it. */
void csg_diag_make_line(char *message);

/* A finding that is not about text: name may be NULL or the file it is about. */
void csg_diag_plain(csg_diag_sink *sink, csg_diag_code code, const char *name, const char *hint,
                    const char *format, ...) __attribute__((format(printf, 5, 6)));

/* A note that so many findings were above the cap. */
void csg_diag_count_dropped(csg_diag_sink *sink, uint32_t count);

#endif
