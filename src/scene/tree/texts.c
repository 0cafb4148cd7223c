/* SPDX-License-Identifier: MIT
 * Texts kept with a scene; see texts.h.
 */
#include "scene/tree/texts.h"

#include <string.h>

bool csg_scene_keep_texts(csgm_scene *scene, const csg_scene_text *texts, size_t count)
{
    csg_scene_text *kept = csg_arena_calloc(&scene->arena, count, sizeof *kept);
    for (size_t i = 0; kept && i < count; i++) {
        size_t same = 0;
        while (same < i && texts[same].text != texts[i].text)
            same++;
        kept[i] = (csg_scene_text){.length = texts[i].length};
        kept[i].name = csg_arena_strndup(&scene->arena, texts[i].name, strlen(texts[i].name));
        kept[i].text = same < i ? kept[same].text
                                : csg_arena_strndup(&scene->arena, texts[i].text, texts[i].length);
        if (!kept[i].name || !kept[i].text)
            return false;
    }
    scene->texts = kept;
    scene->text_count = kept ? count : 0;
    return kept != NULL;
}

/* Line and column of an offset, and the line itself. */
static void place(const csg_scene_text *text, uint32_t offset, csgm_diag *diag)
{
    uint32_t start = 0, end = offset;
    diag->line = 1;
    for (uint32_t i = 0; i < offset; i++)
        if (text->text[i] == '\n') {
            diag->line++;
            start = i + 1;
        }
    while (end < text->length && text->text[end] != '\n' && text->text[end] != '\r')
        end++;
    diag->column = offset - start + 1;
    diag->source_line = text->text + start;
    diag->source_line_length = end - start;
}

bool csg_scene_show_node(const csgm_scene *scene, csg_node_id id, csgm_diag *diag)
{
    if (id >= scene->node_count || scene->nodes[id].where.source >= scene->text_count)
        return false;
    csg_span where = scene->nodes[id].where;
    const csg_scene_text *text = &scene->texts[where.source];
    if (where.offset > text->length)
        return false;
    diag->source_name = text->name;
    place(text, where.offset, diag);
    uint32_t left = diag->source_line_length + 1 - diag->column;
    diag->length = where.length < left ? where.length : left;
    diag->end_line = diag->line;
    diag->end_column = diag->column + diag->length;
    return true;
}
