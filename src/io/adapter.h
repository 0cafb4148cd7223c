/* SPDX-License-Identifier: MIT
 * The one header that C and C++ share: what the outside libraries (and the standard library's
 * number conversions) do for the readers and writers, in plain C terms. No C++ exception or type
 * crosses it. Every adapter reports trouble as a status and one sentence; the caller adds the
 * file's name.
 */
#ifndef CSG_IO_ADAPTER_H
#define CSG_IO_ADAPTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- numbers (number_format.cc) --------------------------------------------------- */

enum { CSG_NUMBER_MOST = 32 }; /* bytes any of the put functions may write */

/* Shortest text that reads back as the same value; not terminated; returns its end. */
char *csg_number_put_float(char *text, float value);
char *csg_number_put_double(char *text, double value);
char *csg_number_put_u64(char *text, uint64_t value);
/* With at most `decimals` digits behind the point (0 to 20), no exponent, no zeros at its end. */
enum { CSG_FIXED_MOST = 352 };
char *csg_number_put_fixed(char *text, double value, int decimals);
/* Reads one decimal number (a leading '+' is taken) at text; returns its end, NULL when there is
 * none. Too large becomes infinity, too small zero. */
const char *csg_number_parse(const char *text, const char *end, double *value);

/* ---- what a reading adapter hands over -------------------------------------------- */

typedef struct csg_adapter_error {
    char text[240]; /* one sentence, terminated */
    bool is_limit;  /* CSGM_ERR_MEMORY for the limit that was given, not for the system */
} csg_adapter_error;

/* One indexed part of a mesh, borrowed. */
typedef struct csg_adapter_part {
    const float *positions;    /* 3 * vertex_count */
    const float *normals;      /* 3 * vertex_count or NULL */
    const float *colors;       /* color_components * vertex_count, 0..1, or NULL */
    uint32_t color_components; /* 3 or 4 */
    const uint32_t *indices;   /* index_count, a multiple of 3, each below vertex_count */
    uint64_t vertex_count, index_count;
    const uint16_t *material; /* metallic and roughness times 10000, or NULL: nothing is said */
    bool begins;              /* a part of the mesh: the first primitive of a node */
    const char *name;         /* of that, or NULL */
} csg_adapter_part;

/* ---- Draco (draco.cc) ------------------------------------------------------------- */

typedef struct csg_draco_settings {
    uint32_t position_bits, normal_bits; /* quantisation */
    uint32_t level;                      /* 0 fast .. 10 small */
} csg_draco_settings;

typedef struct csg_draco_encoded {
    void *owner; /* pass to csg_draco_release */
    const uint8_t *bytes;
    size_t size_bytes;
    uint64_t vertex_count, triangle_count;                    /* of the mesh as encoded */
    uint32_t position_id, normal_id, color_id, coordinate_id; /* unique attribute ids */
} csg_draco_encoded;

/* What to encode: positions finite, at least one triangle, indices in range. Colours are whole
 * numbers of one or two bytes, four per vertex. */
typedef struct csg_draco_mesh {
    const float *positions, *normals; /* normals may be NULL */
    const void *colors;               /* NULL, or 4 * vertex_count of color_bytes each */
    uint32_t color_bytes;             /* 1 or 2 */
    const uint16_t *coordinates;      /* of a texture, 2 * vertex_count, or NULL */
    const float *grid;                /* NULL, or the low corner and size of what is quantised */
    const uint32_t *indices;
    uint64_t vertex_count, triangle_count;
} csg_draco_mesh;

bool csg_draco_available(void);
csgm_status csg_draco_encode(const csg_draco_mesh *mesh, const csg_draco_settings *settings,
                             csg_draco_encoded *out, csg_adapter_error *error);
void csg_draco_release(csg_draco_encoded *encoded); /* no-op on all zero */

/* Attribute ids of a compressed glTF primitive; -1 = it has none. */
typedef struct csg_draco_ids {
    int64_t position, normal, color;
} csg_draco_ids;

typedef struct csg_draco_decoded {
    void *owner; /* pass to csg_draco_release_decoded */
    csg_adapter_part part;
} csg_draco_decoded;

/* ids NULL = by the attributes' own kinds. most_bytes: refuses a file that says it needs more. */
csgm_status csg_draco_decode(const uint8_t *bytes, size_t size_bytes, const csg_draco_ids *ids,
                             uint64_t most_bytes, csg_draco_decoded *out, csg_adapter_error *error);
void csg_draco_release_decoded(csg_draco_decoded *decoded);

/* ---- meshoptimizer (meshopt.c) ---------------------------------------------------- */

typedef enum csg_meshopt_mode {
    CSG_MESHOPT_ATTRIBUTES,
    CSG_MESHOPT_TRIANGLES, /* indices of uint32_t, a multiple of three */
    CSG_MESHOPT_INDICES    /* uint32_t in any order */
} csg_meshopt_mode;

typedef enum csg_meshopt_filter {
    CSG_MESHOPT_NONE,
    CSG_MESHOPT_OCTAHEDRAL,
    CSG_MESHOPT_QUATERNION,
    CSG_MESHOPT_EXPONENTIAL,
    CSG_MESHOPT_COLOR
} csg_meshopt_filter;

bool csg_meshopt_available(void);
/* Orders triangles and vertices for caches and codecs. to[v]: vertex v's number, UINT32_MAX where
 * no triangle uses it. The number of those used. */
uint32_t csg_meshopt_order(uint32_t *indices, uint64_t index_count, uint64_t vertex_count,
                           uint32_t *to);
/* Bytes that csg_meshopt_encode may need. Strides of attributes are multiples of four up to 256;
 * indices are below `beyond`. */
uint64_t csg_meshopt_bound(csg_meshopt_mode mode, uint64_t count, uint64_t stride, uint64_t beyond);
/* The bytes written; 0: there was not room enough. */
uint64_t csg_meshopt_encode(csg_meshopt_mode mode, const void *data, uint64_t count,
                            uint64_t stride, uint8_t *out, uint64_t room);
/* normals: four floats each, the last one zero. out: what the octahedral filter unpacks. */
void csg_meshopt_pack_normals(int8_t *out, const float *normals, uint64_t count, int bits);

/* A compressed view whose numbers obey the extension's rules. */
typedef struct csg_meshopt_view {
    csg_meshopt_mode mode;
    csg_meshopt_filter filter;
    uint64_t count, stride;
    const uint8_t *bytes;
    uint64_t size;
} csg_meshopt_view;

/* out: count * stride bytes. False: the bytes are broken, or of a later version. */
bool csg_meshopt_decode(const csg_meshopt_view *view, void *out);

/* ---- glTF reading (gltf.cc) ------------------------------------------------------- */

/* A part with the place that its node gives it: row-major 3x4, glTF's own axes. */
typedef csgm_status csg_gltf_part_fn(void *user, const csg_adapter_part *part,
                                     const double transform[12]);
/* Brings the bytes of a file named in the document (relative to it, percent signs decoded); they
 * stay valid until csg_gltf_parse returns. CSGM_OK or what went wrong. */
typedef csgm_status csg_gltf_load_fn(void *user, const char *uri, const uint8_t **bytes,
                                     size_t *size_bytes);

typedef struct csg_gltf_calls {
    csg_gltf_part_fn *part;
    csg_gltf_load_fn *load;
    /* Before the first part: what one unit of what is handed over is, where the document says so;
     * what the document has beside parts, in words, where that is anything. */
    void (*unit)(void *user, csgm_unit unit);
    void (*left_out)(void *user, const char *what);
    void *user;
    /* May so many bytes of memory be taken? */
    bool (*allows)(void *user, uint64_t bytes);
    uint64_t most_bytes; /* of memory that decoding may take */
} csg_gltf_calls;

bool csg_gltf_available(void);
/* json: the document; bin: the GLB's second chunk or NULL. CSGM_ERR_FORMAT with a sentence, or
 * what a call returned (then error->text may be empty: it was reported there). */
csgm_status csg_gltf_parse(const char *json, size_t json_bytes, const uint8_t *bin,
                           size_t bin_bytes, const csg_gltf_calls *calls, csg_adapter_error *error);

/* ---- XML, and packages of it (package.c: libzip, expat) ----------------------------- */

typedef struct csg_package csg_package;

/* Names of elements are "namespace|name"; attributes are pairs of name and value, NULL behind the
 * last, named so too where they have a namespace. Anything but CSGM_OK (reported) ends the parse.
 */
typedef struct csg_xml_calls {
    /* A prefix of a namespace, before the element that declares it; NULL = nobody asks. */
    csgm_status (*declare)(void *user, const char *prefix, const char *space);
    csgm_status (*start)(void *user, const char *name, const char *const *attributes);
    csgm_status (*end)(void *user, const char *name);
    void *user;
    /* Some of the text between elements, not ended by \0; NULL = nobody asks. */
    csgm_status (*text)(void *user, const char *text, size_t length);
} csg_xml_calls;

/* XML's white space. */
static inline bool csg_xml_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool csg_package_available(void);
/* The bytes stay the caller's and must outlive the package. */
csgm_status csg_package_open(const uint8_t *bytes, size_t size_bytes, csg_package **out,
                             csg_adapter_error *error);
void csg_package_close(csg_package *package); /* NULL is a no-op */
/* One of the package's files, letters of any case. As csg_gltf_parse about errors. */
csgm_status csg_package_parse(csg_package *package, const char *name, const csg_xml_calls *calls,
                              csg_adapter_error *error);
/* Name of the package's first file; NULL = it has none. The package's storage. */
const char *csg_package_first(csg_package *package);
/* Bytes that are XML themselves. Available where packages are. */
csgm_status csg_package_parse_bytes(const uint8_t *bytes, size_t size_bytes,
                                    const csg_xml_calls *calls, csg_adapter_error *error);

#ifdef __cplusplus
}
#endif
#endif
