/* SPDX-License-Identifier: MIT
 * argv -> cli_options, by the table options.def. Long options are --name value or --name=value,
 * short ones -x value or -xvalue, flags may stand together, -- ends the options.
 */
#include "core/options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/cli.h"
#include "core/command_bits.h"

typedef enum kind {
    FLAG,
    TEXT,
    LIST,
    COUNT,
    NUMBER,
    NONNEGATIVE,
    AMOUNT,
    BYTES,
    CHOICE,
    BOX,
    POINTS,
    REPORT,
    BITS,
    LEVEL
} kind;

typedef struct row {
    kind kind;
    cli_option_id id;
    size_t offset;
    char letter;
    const char *name, *argument;
    int commands;
} row;

static const row rows[] = {
#define SECTION(title)
#define OPTION(field, letter, name, kind, argument, commands, help)                                \
    {kind, CLI_OPTION_##field, offsetof(cli_options, field), letter, name, argument, commands},
#include "core/options.def"
#undef OPTION
};

static const char *const command_names[] = {
#define COMMAND(NAME, name, operands, summary, examples) #name,
#include "core/commands.def"
#undef COMMAND
};

enum { ROW_COUNT = sizeof rows / sizeof *rows };

typedef struct parser {
    cli_options *options;
    cli_problem *problem;
    int argc, next; /* next: the first argument not yet read */
    char **argv;
    size_t list_room; /* no list can grow longer than the command line */
} parser;

__attribute__((format(printf, 3, 4))) static bool refuse(parser *p, const char *hint,
                                                         const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(p->problem->message, sizeof p->problem->message, format, arguments);
    va_end(arguments);
    snprintf(p->problem->hint, sizeof p->problem->hint, "%s", hint ? hint : "");
    return false;
}

/* "--draco-bits", or "-W" for an option with a letter only. */
static const char *row_label(const row *option, char *buffer, size_t size)
{
    if (option->name)
        snprintf(buffer, size, "--%s", option->name);
    else
        snprintf(buffer, size, "-%c", option->letter);
    return buffer;
}

static bool refuse_value(parser *p, const row *option, const char *value, const char *wanted)
{
    char label[40];
    return refuse(p, NULL, "%s wants %s, not '%.80s'", row_label(option, label, sizeof label),
                  wanted, value);
}

/* ---- values -------------------------------------------------------------------------- */

/* A finite decimal number and nothing after it but `end` or the end of the text. */
static bool read_number(const char **text, char end, double *out)
{
    if (!strchr("+-.0123456789", **text) || !**text)
        return false;
    char *after;
    errno = 0;
    *out = strtod(*text, &after);
    if (after == *text || !isfinite(*out) || (*after && *after != end))
        return false;
    *text = *after ? after + 1 : after;
    return true;
}

/* Exactly `count` numbers with commas between. */
static bool read_numbers(const char *text, double *out, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        bool last = i + 1 == count;
        if (!read_number(&text, last ? '\0' : ',', &out[i]) || (!last && !*text))
            return false;
    }
    return *text == '\0';
}

static bool read_count(const char *text, char end, uint64_t least, uint64_t most, uint64_t *out,
                       const char **after)
{
    uint64_t value = 0;
    const char *c = text;
    for (; *c >= '0' && *c <= '9' && value <= most; c++)
        value = value * 10 + (uint64_t)(*c - '0');
    if (c == text || value < least || value > most || (*c && *c != end))
        return false;
    *out = value;
    *after = *c ? c + 1 : c;
    return true;
}

static bool set_count(parser *p, const row *option, const char *text, uint64_t *slot)
{
    const char *after;
    if (read_count(text, '\0', 1, UINT32_MAX, slot, &after))
        return true;
    return refuse_value(p, option, text, "a whole number from 1 to 4294967295");
}

static bool set_level(parser *p, const row *option, const char *text, uint32_t *slot)
{
    const char *after;
    uint64_t level;
    if (!read_count(text, '\0', 0, 10, &level, &after))
        return refuse_value(p, option, text, "a whole number from 0 to 10");
    *slot = (uint32_t)level;
    return true;
}

static bool set_number(parser *p, const row *option, const char *text, double *slot)
{
    double value;
    if (!read_numbers(text, &value, 1) || value <= 0)
        return refuse_value(p, option, text, "a number above 0");
    *slot = value;
    return true;
}

static bool set_amount(parser *p, const row *option, const char *text, cli_amount *slot)
{
    char number[64];
    size_t length = strlen(text);
    bool share = length && length < sizeof number && text[length - 1] == '%';
    double value = 0;
    if (share) {
        memcpy(number, text, length - 1);
        number[length - 1] = '\0';
        text = number;
    }
    if (!read_numbers(text, &value, 1) || value <= 0 || (share && value >= 100))
        return refuse_value(p, option, text,
                            "a length above 0, or a percentage between 0% and 100%");
    *slot = (cli_amount){share ? value / 100 : value, share};
    return true;
}

static bool set_nonnegative(parser *p, const row *option, const char *text, double *slot)
{
    char number[64];
    size_t length = strlen(text);
    bool percent = length > 1 && length < sizeof number && text[length - 1] == '%';
    double value;
    snprintf(number, sizeof number, "%.*s", percent ? (int)length - 1 : 63, text);
    if (!read_numbers(percent ? number : text, &value, 1) || value < 0)
        return refuse_value(p, option, text, "a number, 0 or above, or a percentage");
    *slot = percent ? value / 100 : value;
    return true;
}

static bool set_bytes(parser *p, const row *option, const char *text, uint64_t *slot)
{
    static const char suffixes[] = "KMGT";
    char *after;
    double value = strtod(text, &after);
    const char *suffix = *after ? strchr(suffixes, *after & ~0x20) : NULL;
    bool known =
        *after == '\0' ||
        (suffix && *suffix &&
         (after[1] == '\0' || strcmp(after + 1, "iB") == 0 || strcmp(after + 1, "B") == 0));
    double bytes = suffix ? ldexp(value, 10 * (int)(suffix - suffixes + 1)) : value;
    if (after == text || !known || !(bytes >= 1) || bytes >= 0x1p63)
        return refuse_value(p, option, text, "a size as 500M or 2G");
    *slot = (uint64_t)bytes;
    return true;
}

static bool set_choice(parser *p, const row *option, const char *text, int *slot)
{
    size_t length = strlen(text);
    const char *value = option->argument;
    for (int i = 0; value; i++) {
        size_t end = strcspn(value, "|");
        if (end == length && strncmp(value, text, length) == 0) {
            *slot = i;
            return true;
        }
        value = value[end] ? value + end + 1 : NULL;
    }
    return refuse_value(p, option, text, option->argument);
}

static bool set_box(parser *p, const row *option, const char *text, csgm_box *slot)
{
    double v[6];
    if (!read_numbers(text, v, 6) || !(v[0] < v[3] && v[1] < v[4] && v[2] < v[5]))
        return refuse_value(p, option, text,
                            "six numbers X0,Y0,Z0,X1,Y1,Z1, each of the first three below its "
                            "partner");
    *slot = (csgm_box){{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    return true;
}

static bool set_bits(parser *p, const row *option, const char *text, cli_bits *slot)
{
    uint64_t position = 0, normal = 10, color = 8;
    const char *next = text;
    bool good = read_count(next, ',', 1, 30, &position, &next);
    if (good && *next)
        good = read_count(next, ',', 2, 30, &normal, &next);
    if (good && *next)
        good = read_count(next, '\0', 1, 30, &color, &next);
    if (!good || *next || text[strlen(text) - 1] == ',')
        return refuse_value(p, option, text,
                            "up to three numbers of bits P,N,C from 1 (N: 2) to 30");
    *slot = (cli_bits){(uint32_t)position, (uint32_t)normal, (uint32_t)color};
    return true;
}

static bool add_text(parser *p, cli_list *list, const char *text)
{
    if (!list->items)
        list->items = malloc(p->list_room * sizeof *list->items);
    if (!list->items)
        return refuse(p, NULL, "out of memory");
    list->items[list->count++] = text;
    return true;
}

static bool add_point(parser *p, const row *option, const char *text, cli_points *points)
{
    double v[3];
    if (!read_numbers(text, v, 3))
        return refuse_value(p, option, text, "three numbers X,Y,Z");
    if (!points->items)
        points->items = malloc(p->list_room * sizeof *points->items);
    if (!points->items)
        return refuse(p, NULL, "out of memory");
    points->items[points->count++] = (csgm_vec3){v[0], v[1], v[2]};
    return true;
}

static bool set_option(parser *p, const row *option, const char *value)
{
    void *slot = (char *)p->options + option->offset;
    p->options->given[option->id] = true;
    p->options->texts[option->id] = value;
    switch (option->kind) {
    case FLAG:
        *(bool *)slot = true;
        return true;
    case TEXT:
    case REPORT:
        *(const char **)slot = value;
        return true;
    case LIST:
        return add_text(p, slot, value);
    case COUNT:
        return set_count(p, option, value, slot);
    case NUMBER:
        return set_number(p, option, value, slot);
    case NONNEGATIVE:
        return set_nonnegative(p, option, value, slot);
    case AMOUNT:
        return set_amount(p, option, value, slot);
    case BYTES:
        return set_bytes(p, option, value, slot);
    case CHOICE:
        return set_choice(p, option, value, slot);
    case BOX:
        return set_box(p, option, value, slot);
    case POINTS:
        return add_point(p, option, value, slot);
    case BITS:
        return set_bits(p, option, value, slot);
    case LEVEL:
        return set_level(p, option, value, slot);
    }
    return refuse(p, NULL, "unknown kind of option");
}

/* ---- names --------------------------------------------------------------------------- */

/* Levenshtein's distance; names longer than the row are far from everything. */
static size_t distance(const char *a, const char *b)
{
    enum { MOST = 40 };
    size_t above[MOST + 1], columns = strlen(b);
    if (columns > MOST)
        return SIZE_MAX;
    for (size_t j = 0; j <= columns; j++)
        above[j] = j;
    for (size_t i = 0; a[i]; i++) {
        size_t diagonal = above[0];
        above[0] = i + 1;
        for (size_t j = 0; j < columns; j++) {
            size_t change = diagonal + (a[i] != b[j]);
            size_t remove = above[j + 1] + 1, insert = above[j] + 1;
            diagonal = above[j + 1];
            above[j + 1] = change < remove ? change : remove;
            above[j + 1] = above[j + 1] < insert ? above[j + 1] : insert;
        }
    }
    return above[columns];
}

const char *cli_nearest(const char *text, const char *const *names)
{
    const char *nearest = NULL;
    size_t least = 1 + strlen(text) / 3;
    for (; *names; names++) {
        size_t steps = distance(text, *names);
        if (steps <= least && (!nearest || steps < least)) {
            least = steps;
            nearest = *names;
        }
    }
    return nearest;
}

static bool refuse_unknown(parser *p, const char *name, size_t length)
{
    const char *names[ROW_COUNT + 1];
    size_t count = 0;
    char text[64], hint[128];
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (rows[i].name && rows[i].commands & 1 << p->options->command)
            names[count++] = rows[i].name;
    names[count] = NULL;
    snprintf(text, sizeof text, "%.*s", (int)(length < 60 ? length : 60), name);
    const char *near = cli_nearest(text, names);
    if (near)
        snprintf(hint, sizeof hint, "did you mean '--%s'?", near);
    else
        snprintf(hint, sizeof hint, "csgmesh help %s lists the options",
                 command_names[p->options->command]);
    return refuse(p, hint, "unknown option '--%s'", text);
}

static bool check_row(parser *p, const row *option)
{
    char label[40];
    row_label(option, label, sizeof label);
    if (!(option->commands & 1 << p->options->command))
        return refuse(p, NULL, "%s does not apply to 'csgmesh %s'", label,
                      command_names[p->options->command]);
    return true;
}

static const char *next_argument(parser *p)
{
    return p->next < p->argc ? p->argv[p->next++] : NULL;
}

/* Of rows with one name that for one of these commands, else the first. */
static const row *find_long(const char *name, size_t length, int commands)
{
    const row *first = NULL;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (!rows[i].name || strlen(rows[i].name) != length ||
            strncmp(rows[i].name, name, length) != 0)
            continue;
        if (rows[i].commands & commands)
            return &rows[i];
        first = first ? first : &rows[i];
    }
    return first;
}

/* The same of letters. */
static const row *find_short(char letter, int commands)
{
    const row *first = NULL;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (rows[i].letter != letter)
            continue;
        if (rows[i].commands & commands)
            return &rows[i];
        first = first ? first : &rows[i];
    }
    return first;
}

static bool parse_long(parser *p, const char *name)
{
    size_t length = strcspn(name, "=");
    const char *value = name[length] ? name + length + 1 : NULL;
    const row *option = find_long(name, length, 1 << p->options->command);
    if (!option)
        return refuse_unknown(p, name, length);
    if (!check_row(p, option))
        return false;
    if (option->kind == FLAG && value)
        return refuse(p, NULL, "--%s takes no value", option->name);
    if (option->kind == REPORT && !value)
        value = "-";
    if (option->kind != FLAG && !value)
        value = next_argument(p);
    if (option->kind != FLAG && !value)
        return refuse(p, NULL, "--%s needs %s", option->name, option->argument);
    return set_option(p, option, value);
}

static bool parse_short(parser *p, const char *letters)
{
    for (; *letters; letters++) {
        const row *option = find_short(*letters, 1 << p->options->command);
        if (!option)
            return refuse(p, "csgmesh --help lists the options", "unknown option '-%c'", *letters);
        if (!check_row(p, option))
            return false;
        if (option->kind == FLAG) {
            if (!set_option(p, option, NULL))
                return false;
            continue;
        }
        const char *value = letters[1] ? letters + 1 : next_argument(p);
        if (!value)
            return refuse(p, NULL, "-%c needs %s", *letters, option->argument);
        return set_option(p, option, value);
    }
    return true;
}

bool cli_options_parse(cli_options *options, cli_command command, int argc, char **argv,
                       cli_problem *problem)
{
    parser p = {options, problem, argc, 0, argv, (size_t)argc + 1};
    *options = (cli_options){.command = command};
    *problem = (cli_problem){{0}, {0}};
    bool only_operands = false;
    while (p.next < argc) {
        const char *text = argv[p.next++];
        bool good = true;
        if (only_operands || text[0] != '-' || text[1] == '\0')
            good = add_text(&p, &options->operands, text);
        else if (strcmp(text, "--") == 0)
            only_operands = true;
        else if (text[1] == '-')
            good = parse_long(&p, text + 2);
        else
            good = parse_short(&p, text + 1);
        if (!good)
            return false;
    }
    if (options->stats_full && !options->stats)
        options->stats = "-";
    return true;
}

static bool is_command(const char *text)
{
#define COMMAND(NAME, name, operands, summary, examples) || strcmp(text, #name) == 0
    return false
#include "core/commands.def"
        ;
#undef COMMAND
}

/* Some names take a value with one command and none with another: --json. */
static bool is_somewhere_flag(const char *name, size_t length)
{
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (rows[i].name && rows[i].kind == FLAG && strlen(rows[i].name) == length &&
            strncmp(rows[i].name, name, length) == 0)
            return true;
    return false;
}

/* Does the argument after this one (NULL: there is none) belong to it? */
static bool takes_next(const char *option, const char *next)
{
    const row *found;
    if (option[1] == '-') {
        size_t length = strcspn(option + 2, "=");
        found = find_long(option + 2, length, 0);
        if (next && is_command(next) && is_somewhere_flag(option + 2, length))
            return false;
        return found && !option[2 + length] && found->kind != FLAG && found->kind != REPORT;
    }
    for (const char *letter = option + 1; *letter; letter++) {
        found = find_short(*letter, 0);
        if (!found || found->kind != FLAG)
            return found && !letter[1];
    }
    return false;
}

int cli_options_first_operand(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--") == 0)
            return argc; /* what follows is files */
        if (argv[i][0] != '-' || argv[i][1] == '\0')
            return i;
        i += takes_next(argv[i], i + 1 < argc ? argv[i + 1] : NULL);
    }
    return argc;
}

bool cli_options_unfit(const cli_options *options, cli_command as, size_t *at, char *label,
                       size_t size)
{
    while (*at < ROW_COUNT) {
        const row *option = &rows[(*at)++];
        if (options->given[option->id] && !(option->commands & 1 << as)) {
            row_label(option, label, size);
            return true;
        }
    }
    return false;
}

void cli_options_release(cli_options *options)
{
    for (size_t i = 0; i < ROW_COUNT; i++) {
        void *field = (char *)options + rows[i].offset;
        if (rows[i].kind == LIST)
            free(((cli_list *)field)->items);
        else if (rows[i].kind == POINTS)
            free(((cli_points *)field)->items);
    }
    free(options->operands.items);
}
