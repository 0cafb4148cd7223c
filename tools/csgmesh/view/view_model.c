/* SPDX-License-Identifier: MIT
 * Header and arrays; see view_model.h.
 */
#include "view/view_model.h"

#include <stdlib.h>
#include <string.h>

#include "core/textfile.h"

/* The arrays of a layer, in the order in which they follow each other. */
typedef struct run {
    const char *key;
    const void *items;
    uint64_t count; /* of four bytes each */
} run;

enum { RUNS = 4 };

static void runs_of(const csgm_mesh_view *mesh, run runs[RUNS])
{
    runs[0] = (run){"positions", mesh->positions, 3 * mesh->vertex_count};
    runs[1] = (run){"normals", mesh->normals, 3 * mesh->vertex_count};
    runs[2] = (run){"colors", mesh->colors, mesh->vertex_count};
    runs[3] = (run){"indices", mesh->indices, 3 * mesh->triangle_count};
}

static void put_header(FILE *out, const view_layer *layers, size_t count)
{
    cli_json json = cli_json_make(out, false);
    uint64_t place = 0;
    cli_json_begin(&json, '{');
    cli_json_open(&json, "layers", '[');
    for (size_t i = 0; i < count; i++) {
        run runs[RUNS];
        runs_of(&layers[i].mesh, runs);
        cli_json_open(&json, NULL, '{');
        cli_json_string(&json, "kind", layers[i].kind);
        cli_json_vec3(&json, "origin", layers[i].mesh.origin);
        cli_json_count(&json, "vertices", layers[i].mesh.vertex_count);
        cli_json_count(&json, "triangles", layers[i].mesh.triangle_count);
        for (int k = 0; k < RUNS; k++)
            if (runs[k].items) {
                cli_json_count(&json, runs[k].key, place);
                place += 4 * runs[k].count;
            }
        cli_json_end(&json, '}');
    }
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
}

static void put_word(FILE *out, uint32_t word)
{
    for (int shift = 0; shift < 32; shift += 8)
        fputc((int)(word >> shift & 255), out);
}

/* Colours are bytes already, in the order of the file. */
static void put_run(FILE *out, const run *r)
{
    const uint8_t *bytes = r->items;
    bool is_bytes = !strcmp(r->key, "colors");
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    is_bytes = true;
#endif
    if (is_bytes) {
        fwrite(bytes, 4, r->count, out);
        return;
    }
    for (uint64_t i = 0; i < r->count; i++) {
        uint32_t word;
        memcpy(&word, bytes + 4 * i, sizeof word);
        put_word(out, word);
    }
}

char *view_model_make(const view_layer *layers, size_t count, size_t *length)
{
    cli_text header, model;
    if (cli_text_open(&header))
        put_header(header.out, layers, count);
    char *text = cli_text_close(&header);
    if (text && cli_text_open(&model)) {
        size_t padded = (header.length + 3) / 4 * 4;
        put_word(model.out, (uint32_t)padded);
        fprintf(model.out, "%-*s", (int)padded, text);
        for (size_t i = 0; i < count; i++) {
            run runs[RUNS];
            runs_of(&layers[i].mesh, runs);
            for (int k = 0; k < RUNS; k++)
                if (runs[k].items)
                    put_run(model.out, &runs[k]);
        }
    } else {
        model = (cli_text){.out = NULL};
    }
    free(text);
    char *bytes = cli_text_close(&model);
    *length = model.length;
    return bytes;
}
