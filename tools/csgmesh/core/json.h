/* SPDX-License-Identifier: MIT
 * JSON as a stream of members. key NULL = an element of an array.
 */
#ifndef CLI_JSON_H
#define CLI_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "csgmesh/csgmesh.h"

typedef struct cli_json {
    FILE *out;
    bool pretty; /* members of the two outer levels on lines of their own */
    bool first;
    bool breaks; /* the next element begins a line */
    int depth;
} cli_json;

cli_json cli_json_make(FILE *out, bool pretty);
/* bracket: '{' or '['; the outermost has no key. */
void cli_json_begin(cli_json *json, char bracket);
/* The next member or element begins a line, or the bracket that closes them. */
void cli_json_break(cli_json *json);
void cli_json_open(cli_json *json, const char *key, char bracket);
void cli_json_end(cli_json *json, char bracket);
void cli_json_count(cli_json *json, const char *key, uint64_t value);
void cli_json_integer(cli_json *json, const char *key, int64_t value);
/* Shortest text that reads back as the same double; null for what JSON cannot say. */
void cli_json_number(cli_json *json, const char *key, double value);
void cli_json_bool(cli_json *json, const char *key, bool value);
/* Bytes that are no UTF-8 become U+FFFD. */
void cli_json_string(cli_json *json, const char *key, const char *text);
/* A string of digits and base64, put to json->out between the two as it is. */
void cli_json_open_plain(cli_json *json, const char *key);
void cli_json_close_plain(cli_json *json);
/* A member whose value is JSON already. */
void cli_json_verbatim(cli_json *json, const char *key, const char *value);
void cli_json_vec3(cli_json *json, const char *key, csgm_vec3 value);
/* [[x, y, z], [x, y, z]], null for the empty box. */
void cli_json_box(cli_json *json, const char *key, csgm_box box);

/* The shortest of %.15g, %.16g and %.17g that reads back as the same double. */
void cli_format_double(char *buffer, size_t size, double value);

#endif
