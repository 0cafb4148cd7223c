/* SPDX-License-Identifier: MIT
 * Colours that a text names, and what of it may be folded; see csgmesh/editing.h.
 */
#include <string.h>

#include "lang/edit/workspace.h"
#include "lang/modules/modules.h"

/* The file, or NULL: none that can be read. */
static csg_edit_file *look_up(csgm_workspace *workspace, const char *path)
{
    csg_workspace_begin(workspace);
    csg_edit_file *file = csg_workspace_file(workspace, path);
    return file && file->text ? file : NULL;
}

static csgm_status outcome(const csgm_workspace *workspace)
{
    return workspace->no_memory ? csg_context_no_memory(workspace->context) : CSGM_OK;
}

/* Is it the argument of color(), or does it begin with '#'? */
static bool may_be_color(const csg_edit_file *file, uint32_t index, const char *text)
{
    const csg_edit_piece *pieces = file->pieces.items;
    bool is_argument = index >= 2 && pieces[index - 1].token == CSG_TOKEN_OPEN_ROUND &&
                       pieces[index - 2].token == CSG_TOKEN_NAME && pieces[index - 2].length == 5 &&
                       memcmp(file->text + pieces[index - 2].offset, "color", 5) == 0;
    return is_argument || text[0] == '#';
}

csgm_status csgm_workspace_colors(csgm_workspace *workspace, const char *path,
                                  csgm_text_color_fn *each, void *user)
{
    enum { LONGEST = 40 };
    char text[LONGEST + 1];
    if (!workspace || !path || !each)
        return CSGM_ERR_ARGUMENT;
    const csg_edit_file *file = look_up(workspace, path);
    for (uint32_t i = 0; file && i < file->pieces.count; i++) {
        const csg_edit_piece *piece = &file->pieces.items[i];
        csg_color color;
        if (piece->token != CSG_TOKEN_STRING || piece->length < 3 || piece->length > LONGEST)
            continue;
        memcpy(text, file->text + piece->offset + 1, piece->length - 2);
        text[piece->length - 2] = '\0';
        if (!may_be_color(file, i, text) || !csg_color_parse(text, piece->length - 2, &color))
            continue;
        csgm_text_color found = {piece->offset,   piece->offset + piece->length,
                                 (double)color.r, (double)color.g,
                                 (double)color.b, (double)color.a};
        if (!each(user, &found))
            break;
    }
    return outcome(workspace);
}

static uint32_t last_line_of(const csg_edit_file *file, const csg_edit_piece *piece)
{
    uint32_t line = piece->line;
    for (uint32_t i = 0; i < piece->length; i++)
        line += file->text[piece->offset + i] == '\n';
    return line;
}

csgm_status csgm_workspace_folds(csgm_workspace *workspace, const char *path, csgm_fold_fn *each,
                                 void *user)
{
    if (!workspace || !path || !each)
        return CSGM_ERR_ARGUMENT;
    const csg_edit_file *file = look_up(workspace, path);
    for (uint32_t i = 0; file && i < file->pieces.count; i++) {
        const csg_edit_piece *piece = &file->pieces.items[i];
        csgm_fold fold = {piece->line, piece->line, piece->kind != CSG_EDIT_TOKEN};
        if (csg_token_opens(piece->token) && piece->mate != CSG_EDIT_NONE)
            fold.last_line = file->pieces.items[piece->mate].line - 1; /* the bracket stays */
        else if (piece->kind == CSG_EDIT_BLOCK_COMMENT)
            fold.last_line = last_line_of(file, piece);
        while (piece->kind == CSG_EDIT_LINE_COMMENT && i + 1 < file->pieces.count &&
               file->pieces.items[i + 1].kind == CSG_EDIT_LINE_COMMENT &&
               file->pieces.items[i + 1].breaks == 1)
            fold.last_line = file->pieces.items[++i].line;
        if (fold.last_line > fold.first_line && fold.last_line != UINT32_MAX && !each(user, &fold))
            break;
    }
    return outcome(workspace);
}
