/* SPDX-License-Identifier: MIT
 * The command line as a struct. options.def and commands.def are the lists; a field's type follows
 * from its kind.
 */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

typedef struct cli_list {
    const char **items; /* borrowed from argv */
    size_t count;
} cli_list;

typedef struct cli_points {
    csgm_vec3 *items;
    size_t count;
} cli_points;

typedef struct cli_bits {
    uint32_t position, normal, color;
} cli_bits;

/* One C type for each kind of option. */
typedef bool cli_kind_FLAG;
typedef const char *cli_kind_TEXT;
typedef cli_list cli_kind_LIST;
typedef uint64_t cli_kind_COUNT; /* 1 .. 2^32 - 1 */
typedef double cli_kind_NUMBER;  /* > 0, finite */
typedef double cli_kind_MEASURE; /* >= 0, finite; P% is P / 100 */
typedef struct cli_amount {
    double value; /* > 0, finite; a share is below 1 */
    bool is_share;
} cli_amount;
typedef cli_amount cli_kind_AMOUNT; /* a length, or P% */
typedef uint64_t cli_kind_BYTES;    /* K, M, G, T are powers of 1024 */
typedef int cli_kind_CHOICE;        /* index into the values */
typedef csgm_box cli_kind_BOX;      /* finite, min < max */
typedef cli_points cli_kind_POINTS;
typedef const char *cli_kind_REPORT; /* optional "=FILE"; "-" without */
typedef cli_bits cli_kind_BITS;
typedef uint32_t cli_kind_LEVEL; /* 0 .. 10 */

typedef enum cli_command {
#define COMMAND(NAME, name, operands, summary, examples) CLI_##NAME,
#include "core/commands.def"
#undef COMMAND
    CLI_COMMAND_COUNT
} cli_command;

typedef enum cli_option_id {
#define SECTION(title)
#define OPTION(field, letter, name, kind, argument, commands, help) CLI_OPTION_##field,
#include "core/options.def"
#undef OPTION
    CLI_OPTION_COUNT
} cli_option_id;

typedef struct cli_options {
#define OPTION(field, letter, name, kind, argument, commands, help) cli_kind_##kind field;
#include "core/options.def"
#undef OPTION
#undef SECTION
    cli_command command;
    cli_list operands;
    bool given[CLI_OPTION_COUNT];
    const char *texts[CLI_OPTION_COUNT]; /* values as they were given, the last; NULL of a FLAG */
} cli_options;

/* What was wrong with the command line, for one line on stderr. */
typedef struct cli_problem {
    char message[320];
    char hint[320]; /* "" = none */
} cli_problem;

/* argv[1...]; the command is already known. On false *problem says why. The options own their lists
 * either way. */
bool cli_options_parse(cli_options *options, cli_command command, int argc, char **argv,
                       cli_problem *problem);
/* The index of the first argument that is neither an option nor an option's value; argc: none. What
 * is wrong with the options is not told here. */
int cli_options_first_operand(int argc, char **argv);
/* The next option that was given and that another command does not take; *at: 0 for the first.
 * false: there is none. */
bool cli_options_unfit(const cli_options *options, cli_command as, size_t *at, char *label,
                       size_t size);
void cli_options_release(cli_options *options);

/* The name in `names` (NULL at the end) nearest to `text`, NULL when none is near. */
const char *cli_nearest(const char *text, const char *const *names);

#endif
