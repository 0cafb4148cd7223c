/* SPDX-License-Identifier: MIT
 * Files whose triangles are gone through one after the other, several times, without being held:
 * for what asks only what is in a mesh (inspect_file.c). Memory does not grow with the file.
 *
 * A kind does not say what is wrong with a file's begin: its reader does, since what has no runs is
 * read as a whole.
 */
#ifndef CSG_IO_RUNS_H
#define CSG_IO_RUNS_H

#include "base/geometry.h"
#include "io/read_clock.h"

/* A file under way. */
typedef struct csg_runs {
    csgm_context *context;
    csg_read_clock clock;
    const char *path; /* for diagnostics */
    int fd;
    uint64_t size_bytes;
    uint8_t *window; /* a stretch of the file, of which [at, end) is still to come */
    size_t at, end;
    uint64_t window_ends; /* where in the file the window's end is */
    void *state;          /* of the kind: state_bytes, zero at first */
    uint64_t cache_bytes; /* that a kind may take for what it wants again and again */
    csgm_vec3 origin;     /* of positions; zero unless floats about zero are too coarse */
    bool names_vertices;  /* triangles say vertices by number, else by place alone */
    bool has_normals, has_colors;
    uint64_t vertex_count; /* where they have numbers */
} csg_runs;

typedef struct csg_runs_triangle {
    uint32_t vertex[3]; /* where they have numbers */
    float at[3][3];     /* about the origin; not -0 */
} csg_runs_triangle;

typedef struct csg_runs_kind {
    size_t state_bytes;
    /* Reads the head. CSGM_ERR_UNSUPPORTED, not reported: this file has no runs, or is broken;
     * other failures are reported. */
    csgm_status (*begin)(csg_runs *runs);
    /* Before the first triangle, again. */
    csgm_status (*rewind)(csg_runs *runs);
    /* *is_there: there is one more. Without `places` at is not wanted. Reports what fails. */
    csgm_status (*next)(csg_runs *runs, bool places, csg_runs_triangle *triangle, bool *is_there);
    void (*end)(csg_runs *runs); /* gives back what begin has taken; NULL = nothing */
} csg_runs_kind;

/* One for each row of formats.def; those exist that the row says. */
#define CSG_FORMAT(ID, name, ...) extern const csg_runs_kind csg_##name##_runs;
#include "io/formats.def"

enum { CSG_RUNS_WINDOW_BYTES = 1 << 18 };

/* The window begins anew, at this byte of the file. */
void csg_runs_seek(csg_runs *runs, uint64_t byte);
/* The next bytes, at most 4096; NULL: the file ends before, or *status says what else. */
const uint8_t *csg_runs_take(csg_runs *runs, size_t count, csgm_status *status);
/* Bytes from elsewhere in the file. Reports what fails; a file that has become shorter is broken.
 */
csgm_status csg_runs_read_at(csg_runs *runs, void *bytes, size_t count, uint64_t byte);

#endif
