/* SPDX-License-Identifier: MIT
 * Both meshes of a comparison as JSON for the page: arrays of little-endian integers in base64, the
 * box that they fill, the scale of the colours and the first view.
 */
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/textfile.h"
#include "diff/diff_report.h"
#include "diff/diff_thin.h"

/* A stream of bytes in base64. */
typedef struct encoder {
    FILE *out;
    uint32_t bits, bytes;
} encoder;

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void put_byte(encoder *e, uint32_t byte)
{
    e->bits = e->bits << 8 | (byte & 255);
    if (++e->bytes < 3)
        return;
    for (int shift = 18; shift >= 0; shift -= 6)
        fputc(digits[e->bits >> shift & 63], e->out);
    e->bits = e->bytes = 0;
}

static void put_end(encoder *e)
{
    uint32_t bytes = e->bytes;
    if (bytes == 0)
        return;
    uint32_t bits = e->bits << 8 * (3 - bytes);
    for (uint32_t i = 0; i < 4; i++)
        fputc(i <= bytes ? digits[bits >> (18 - 6 * i) & 63] : '=', e->out);
}

static void put_array(cli_json *json, const char *key, const void *items, size_t count, size_t size)
{
    encoder e = {.out = json->out};
    if (!items)
        return;
    cli_json_open_plain(json, key);
    for (size_t i = 0; i < count; i++) {
        uint32_t item = size == 4   ? ((const uint32_t *)items)[i]
                        : size == 2 ? ((const uint16_t *)items)[i]
                                    : ((const uint8_t *)items)[i];
        for (size_t k = 0; k < size; k++)
            put_byte(&e, item >> 8 * k);
    }
    put_end(&e);
    cli_json_close_plain(json);
}

static void put_model(cli_json *json, const char *key, const diff_thin *mesh)
{
    cli_json_open(json, key, '{');
    cli_json_count(json, "vertices", mesh->vertex_count);
    cli_json_count(json, "triangles", mesh->triangle_count);
    cli_json_number(json, "cell", mesh->cell);
    put_array(json, "positions", mesh->positions, (size_t)mesh->vertex_count * 3, 2);
    put_array(json, "heat", mesh->heat, mesh->vertex_count, 2);
    put_array(json, "colors", mesh->colors, (size_t)mesh->vertex_count * 3, 1);
    put_array(json, "indices", mesh->indices, (size_t)mesh->triangle_count * 3, 4);
    cli_json_end(json, '}');
}

static void put_numbers(cli_json *json, const char *key, const double *values, size_t count)
{
    cli_json_open(json, key, '[');
    for (size_t i = 0; i < count; i++)
        cli_json_number(json, NULL, values[i]);
    cli_json_end(json, ']');
}

static void put_frame(cli_json *json, const diff_drawing *d)
{
    double box[6] = {d->box.min.x, d->box.min.y, d->box.min.z,
                     d->box.max.x, d->box.max.y, d->box.max.z};
    double toward[3] = {d->toward.x, d->toward.y, d->toward.z};
    put_numbers(json, "box", box, 6);
    put_numbers(json, "toward", toward, 3);
    put_numbers(json, "most", &d->most, 1);
    cli_json_open(json, "stops", '[');
    for (int i = 0; i <= 4; i++) {
        uint8_t rgb[3];
        csgm_diff_color(i, 4, rgb);
        put_numbers(json, NULL, (double[]){rgb[0], rgb[1], rgb[2]}, 3);
    }
    cli_json_end(json, ']');
}

static bool put_models(FILE *out, const diff_drawing *d, uint64_t *room)
{
    static const char *const keys[2] = {"a", "b"};
    cli_json json = cli_json_make(out, false);
    bool good = true;
    cli_json_begin(&json, '{');
    for (int side = 0; good && side < 2; side++) {
        diff_thin mesh;
        uint64_t most = *room / 2 < DIFF_PAGE_MESH_MOST ? *room / 2 : DIFF_PAGE_MESH_MOST;
        good = diff_thin_make(d, side, most, &mesh);
        if (good) {
            put_model(&json, keys[side], &mesh);
            *room -= mesh.triangle_count < *room ? mesh.triangle_count : *room;
        }
        diff_thin_release(&mesh);
    }
    put_frame(&json, d);
    cli_json_end(&json, '}');
    return good;
}

char *diff_models_text(const diff_drawing *drawing, uint64_t *room)
{
    enum { LEAST = 20000 }; /* fewer would show nothing */
    cli_text text;
    uint64_t wanted = drawing->sides[0].triangle_count + drawing->sides[1].triangle_count;
    if (*room < LEAST && wanted > *room)
        return strdup("null");
    bool good = cli_text_open(&text) && put_models(text.out, drawing, room);
    char *models = cli_text_close(&text);
    if (good)
        return models;
    free(models);
    return NULL;
}
