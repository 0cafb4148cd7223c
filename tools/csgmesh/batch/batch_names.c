/* SPDX-License-Identifier: MIT
 * Expanding patterns; see batch_names.h.
 */
#include "batch/batch_names.h"

#include <string.h>

enum { SCENE, FOLDER, SET, PART, EXT, WORDS };

static const char *const words[WORDS] = {"scene", "folder", "set", "part", "ext"};

/* The placeholder that begins at `text` (a '{'); WORDS: none. *length with the braces. */
static int placeholder(const char *text, size_t *length)
{
    for (int i = 0; i < WORDS; i++) {
        size_t n = strlen(words[i]);
        *length = n + 2;
        if (strncmp(text + 1, words[i], n) == 0 && text[1 + n] == '}')
            return i;
    }
    return WORDS;
}

static bool has_word(const char *pattern, int word)
{
    size_t length;
    for (const char *c = pattern; (c = strchr(c, '{')); c++)
        if (placeholder(c, &length) == word)
            return true;
    return false;
}

bool batch_name_has_part(const char *pattern)
{
    return has_word(pattern, PART);
}

const char *batch_name_problem(cli_arena *arena, const char *pattern)
{
    size_t length;
    for (const char *c = pattern; (c = strchr(c, '{')); c++)
        if (placeholder(c, &length) == WORDS)
            return cli_arena_printf(arena, "there is no '%.*s'", (int)strcspn(c, "}") + 1, c);
    if (!has_word(pattern, EXT))
        return "without {ext} all formats have one name";
    return NULL;
}

static bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7F;
}

static const char *clean(cli_arena *arena, const char *value, bool keeps_slashes)
{
    char *copy = (char *)cli_arena_strdup(arena, value);
    for (char *c = copy; *c; c++)
        if (is_control(*c) || (*c == '/' && !keeps_slashes))
            *c = '_';
    return copy;
}

static const char *stem(cli_arena *arena, const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return cli_arena_strndup(arena, name, dot && dot != name ? (size_t)(dot - name) : strlen(name));
}

static const char *value_of(cli_arena *arena, int word, const batch_name_parts *parts)
{
    const char *values[WORDS] = {[SCENE] = word == SCENE ? stem(arena, parts->scene) : NULL,
                                 [FOLDER] = parts->folder,
                                 [SET] = parts->set,
                                 [PART] = parts->part,
                                 [EXT] = parts->ext};
    return values[word] ? clean(arena, values[word], word == FOLDER) : "";
}

const char *batch_name_expand(cli_arena *arena, const char *pattern, const batch_name_parts *parts)
{
    const char *name = "";
    while (*pattern) {
        size_t plain = strcspn(pattern, "{"), length;
        name = cli_arena_printf(arena, "%s%.*s", name, (int)plain, pattern);
        pattern += plain;
        if (!*pattern)
            break;
        int word = placeholder(pattern, &length);
        const char *value = word < WORDS ? value_of(arena, word, parts) : "";
        pattern += length;
        size_t end = strlen(name);
        if (!*value && end && strchr("-_. ", name[end - 1]))
            end--;
        if (!*value && *pattern == '/' && (!end || name[end - 1] == '/'))
            pattern++;
        name = cli_arena_printf(arena, "%.*s%s", (int)end, name, value);
    }
    return name;
}

bool batch_name_stays_below(const char *name)
{
    if (!*name)
        return false;
    for (;;) {
        size_t length = strcspn(name, "/");
        if (length == 0 || (length == 1 && name[0] == '.') ||
            (length == 2 && name[0] == '.' && name[1] == '.'))
            return false;
        if (!name[length])
            return true;
        name += length + 1;
    }
}
