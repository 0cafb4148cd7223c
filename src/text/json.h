/* SPDX-License-Identifier: MIT
 * JSON text -> a stream of events, by the one JSON library (json.cc). Nothing is kept, numbers come
 * as they are written, no C++ exception or type crosses.
 */
#ifndef CSG_TEXT_JSON_H
#define CSG_TEXT_JSON_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum csg_json_kind {
    CSG_JSON_OBJECT, /* '{' */
    CSG_JSON_ARRAY,  /* '[' */
    CSG_JSON_END,    /* of the innermost of both */
    CSG_JSON_KEY,
    CSG_JSON_STRING,
    CSG_JSON_NUMBER,
    CSG_JSON_WORD /* true, false, null */
} csg_json_kind;

/* text: of KEY, STRING (unescaped), NUMBER and WORD; borrowed, may hold NULs, not terminated.
 * false = stop. */
typedef bool csg_json_fn(void *user, csg_json_kind kind, const char *text, size_t length);

typedef enum csg_json_outcome {
    CSG_JSON_DONE,
    CSG_JSON_STOPPED, /* the callback said so */
    CSG_JSON_BROKEN,
    CSG_JSON_NO_MEMORY
} csg_json_outcome;

typedef struct csg_json_error { /* of BROKEN */
    size_t offset;              /* of the byte that is wrong */
    char text[200];             /* what is wrong, terminated */
} csg_json_error;

/* Does this build have the library? */
bool csg_json_available(void);
csg_json_outcome csg_json_read(const char *text, size_t length, csg_json_fn *event, void *user,
                               csg_json_error *error);

#ifdef __cplusplus
}
#endif
#endif
