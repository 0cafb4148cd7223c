/* SPDX-License-Identifier: MIT
 * A small JSON writer; see json.h. The stream remembers its own errors.
 */
#include "core/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

cli_json cli_json_make(FILE *out, bool pretty)
{
    return (cli_json){.out = out, .pretty = pretty, .first = true};
}

/* U+FFFD for a byte that does not begin a well-formed sequence. Returns its length. */
static size_t put_character(FILE *out, const unsigned char *c)
{
    size_t more = c[0] < 0x80                   ? 0
                  : c[0] >= 0xC2 && c[0] < 0xE0 ? 1
                  : (c[0] & 0xF0) == 0xE0       ? 2
                  : c[0] >= 0xF0 && c[0] < 0xF5 ? 3
                                                : SIZE_MAX;
    for (size_t i = 1; more != SIZE_MAX && i <= more; i++)
        if ((c[i] & 0xC0) != 0x80)
            more = SIZE_MAX;
    /* overlong forms, surrogates, beyond U+10FFFF */
    if (more != SIZE_MAX && more > 1 &&
        ((c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xED && c[1] > 0x9F) ||
         (c[0] == 0xF0 && c[1] < 0x90) || (c[0] == 0xF4 && c[1] > 0x8F)))
        more = SIZE_MAX;
    if (more == SIZE_MAX) {
        fputs("\\ufffd", out);
        return 1;
    }
    if (c[0] < 0x20 || c[0] == 0x7F)
        fprintf(out, "\\u%04x", c[0]);
    else if (c[0] == '"' || c[0] == '\\')
        fprintf(out, "\\%c", c[0]);
    else
        fwrite(c, 1, more + 1, out);
    return more + 1;
}

static void put_text(FILE *out, const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    fputc('"', out);
    while (*c)
        c += put_character(out, c);
    fputc('"', out);
}

static void put_key(cli_json *json, const char *key)
{
    bool breaks = json->breaks || (key && json->pretty && json->depth <= 2);
    if (!json->first)
        fputs(breaks ? "," : ", ", json->out);
    if (breaks)
        fprintf(json->out, "\n%*s", 2 * json->depth, "");
    json->breaks = false;
    if (key) {
        put_text(json->out, key);
        fputs(": ", json->out);
    }
    json->first = false;
}

void cli_json_begin(cli_json *json, char bracket)
{
    fputc(bracket, json->out);
    json->depth++;
    json->first = true;
}

void cli_json_break(cli_json *json)
{
    json->breaks = true;
}

void cli_json_open(cli_json *json, const char *key, char bracket)
{
    put_key(json, key);
    cli_json_begin(json, bracket);
}

void cli_json_end(cli_json *json, char bracket)
{
    json->depth--;
    if (json->breaks || (json->pretty && json->depth <= 1 && bracket == '}'))
        fprintf(json->out, "\n%*s", 2 * json->depth, "");
    fputc(bracket, json->out);
    json->first = json->breaks = false;
    if (json->pretty && json->depth == 0)
        fputc('\n', json->out);
}

void cli_json_count(cli_json *json, const char *key, uint64_t value)
{
    put_key(json, key);
    fprintf(json->out, "%" PRIu64, value);
}

void cli_json_integer(cli_json *json, const char *key, int64_t value)
{
    put_key(json, key);
    fprintf(json->out, "%" PRId64, value);
}

void cli_format_double(char *buffer, size_t size, double value)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buffer, size, "%.*g", digits, value);
        if (strtod(buffer, NULL) == value)
            break;
    }
}

void cli_json_number(cli_json *json, const char *key, double value)
{
    char text[32] = "null";
    put_key(json, key);
    if (isfinite(value))
        cli_format_double(text, sizeof text, value);
    fputs(text, json->out);
}

void cli_json_bool(cli_json *json, const char *key, bool value)
{
    put_key(json, key);
    fputs(value ? "true" : "false", json->out);
}

void cli_json_string(cli_json *json, const char *key, const char *text)
{
    put_key(json, key);
    put_text(json->out, text);
}

void cli_json_open_plain(cli_json *json, const char *key)
{
    put_key(json, key);
    fputc('"', json->out);
}

void cli_json_close_plain(cli_json *json)
{
    fputc('"', json->out);
}

void cli_json_verbatim(cli_json *json, const char *key, const char *value)
{
    put_key(json, key);
    fputs(value, json->out);
}

void cli_json_vec3(cli_json *json, const char *key, csgm_vec3 value)
{
    cli_json_open(json, key, '[');
    cli_json_number(json, NULL, value.x);
    cli_json_number(json, NULL, value.y);
    cli_json_number(json, NULL, value.z);
    cli_json_end(json, ']');
}

void cli_json_box(cli_json *json, const char *key, csgm_box box)
{
    if (box.min.x > box.max.x) {
        put_key(json, key);
        fputs("null", json->out);
        return;
    }
    cli_json_open(json, key, '[');
    cli_json_vec3(json, NULL, box.min);
    cli_json_vec3(json, NULL, box.max);
    cli_json_end(json, ']');
}
