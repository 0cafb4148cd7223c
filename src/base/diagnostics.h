/* SPDX-License-Identifier: MIT
 * Where findings go: counted, summed up where they repeat, and handed to the user's callback. The
 * codes stand in two tables, scene_codes.def and mesh_codes.def. text/source.h turns a span into
 * file, line and column and reports through this.
 *
 * What is shown: each error, the first hundred of them with their line and hint; each warning of
 * what a mesh or file lacks, so also each that is an error in a strict text; of other warnings the
 * first few of each kind in each file, and how many more there are. Warnings inside a library,
 * which its user did not write, are one note in all.
 */
#ifndef CSG_BASE_DIAGNOSTICS_H
#define CSG_BASE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

typedef uint32_t csg_diag_code; /* CSG_DIAG_ of scene_codes.h or mesh_codes.h */

enum {
    CSG_DIAG_ERRORS_IN_FULL = 100, /* errors with their source line, hint and notes */
    CSG_DIAG_ERRORS_MOST = 1000,   /* errors shown at all; the others are counted */
    CSG_DIAG_WARNINGS_ALIKE = 5,   /* warnings of one kind in one file that are shown */
    CSG_DIAG_WARNINGS_MOST = 40,   /* warnings shown, but for those of what is missing */
    CSG_DIAG_GROUPS_MOST = 48
};

/* Warnings that belong together: of one kind in one file, or all inside one library. */
typedef struct csg_diag_group {
    csg_diag_code code; /* 0: of a library */
    char name[128];     /* of the file or library: the end of it where it is longer */
    uint32_t shown, more;
} csg_diag_group;

typedef struct csg_diag_sink {
    csgm_diag_fn *on_diag; /* NULL = silent */
    void *user;
    bool warnings_as_errors;
    bool library_warnings;     /* warnings inside libraries are treated as all others */
    bool errors_only;          /* somebody else says the warnings, who finds the same */
    bool mute_notes;           /* the last finding was not shown, or in short: drop its notes too */
    uint32_t errors, warnings; /* all of them, shown or not */
    uint32_t errors_more;      /* errors that were not shown */
    uint32_t warnings_more;    /* warnings that were not shown and are in no group */
    uint32_t warnings_shown;
    csg_diag_group groups[CSG_DIAG_GROUPS_MOST];
    uint32_t group_count;
} csg_diag_sink;

/* In the tables: an error in a strict text, a warning in a lenient one. */
enum { CSG_STRICT_ERROR = CSGM_ERROR + 1 };

/* Severity of the code's table row (warnings_as_errors not applied), in a strict text. */
csgm_severity csg_diag_severity(csg_diag_code code);
/* Is it only a warning in a lenient text? */
bool csg_diag_may_be_lenient(csg_diag_code code);
/* The table's one-line summary of a code, NULL for an unknown one. */
const char *csg_diag_summary(csg_diag_code code);

/* Fills severity and code, applies warnings_as_errors, counts, and calls on_diag if it is shown. */
void csg_diag_report(csg_diag_sink *sink, csg_diag_code code, csgm_diag diag);
/* Would this finding be shown? For callers to whom its text is work. diag: source_name and library.
 */
bool csg_diag_is_shown(const csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag);

/* Makes a message one line of whole characters, whatever the text of a scene put into it. */
void csg_diag_make_line(char *message);

/* A finding that is not about text: name may be NULL or the file it is about. */
void csg_diag_plain(csg_diag_sink *sink, csg_diag_code code, const char *name, const char *hint,
                    const char *format, ...) __attribute__((format(printf, 5, 6)));

/* Notes of how many findings were not shown; forgets them. */
void csg_diag_sum_up(csg_diag_sink *sink);

#endif
