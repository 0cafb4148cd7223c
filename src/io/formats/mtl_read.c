/* SPDX-License-Identifier: MIT
 * .mtl -> materials; see mtl.h. What else a material says (specular colour, illumination models) is
 * passed over, pictures are noted. A line that is no statement of such a file is passed over, too:
 * the triangles do not depend on it.
 */
#include "io/formats/mtl.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/beneath.h"
#include "io/color.h"
#include "io/text/scan.h"

enum { MOST_FILES = 64 };

void csg_mtl_library_init(csg_mtl_library *library, csgm_context *context)
{
    *library = (csg_mtl_library){.materials = NULL};
    csg_arena_init(&library->names, &context->memory);
}

void csg_mtl_library_release(csg_mtl_library *library)
{
    csg_memory *memory = library->names.memory;
    csg_memory_release(memory, library->materials, library->room * sizeof *library->materials);
    csg_memory_release(memory, library->sorted, library->sorted_room * sizeof *library->sorted);
    csg_arena_reset(&library->names);
}

/* ---- a file ----------------------------------------------------------------------------------
 */

static bool begin_material(csg_mtl_library *library, csg_text_scan *scan)
{
    size_t length;
    const char *name = csg_scan_rest(scan, &length);
    char *copy = csg_arena_strndup(&library->names, name, length);
    csg_memory *memory = library->names.memory;
    if (!copy ||
        !csg_memory_reserve(memory, (void **)&library->materials, &library->room,
                            library->count + 1, sizeof *library->materials) ||
        !csg_memory_reserve(memory, (void **)&library->sorted, &library->sorted_room,
                            library->count + 1, sizeof *library->sorted))
        return false;
    library->sorted[library->count] = (csg_mtl_entry){copy, (uint32_t)library->count};
    library->materials[library->count++] = (csg_mtl_material){
        .color = {255, 255, 255, 255},
        .finish = {CSG_MATERIAL_METALLIC, CSG_MATERIAL_ROUGHNESS},
    };
    return true;
}

static void read_color(csg_mtl_material *material, csg_text_scan *scan)
{
    double rgb[3];
    for (int k = 0; k < 3; k++)
        if (!csg_scan_number(scan, &rgb[k]))
            return; /* a spectrum, or CIE XYZ */
    for (int k = 0; k < 3; k++)
        material->color[k] = csg_color_to_byte((float)rgb[k]);
    material->has_color = true;
}

static void read_opacity(csg_mtl_material *material, csg_text_scan *scan, bool is_transparency)
{
    double value;
    if (!csg_scan_number(scan, &value))
        return;
    material->color[3] = csg_color_to_byte((float)(is_transparency ? 1 - value : value));
    material->has_color |= material->color[3] != 255;
}

static void read_finish(csg_mtl_material *material, csg_text_scan *scan, int which)
{
    double value;
    if (!csg_scan_number(scan, &value) || !(value >= 0) || value > 1)
        return;
    material->finish[which] = (uint16_t)(value * CSG_MATERIAL_ONE + 0.5);
    material->has_finish = true;
}

static bool read_line(csg_mtl_library *library, csg_text_scan *scan)
{
    const char *word;
    size_t length = csg_scan_word(scan, &word);
    if (csg_scan_is(word, length, "newmtl"))
        return begin_material(library, scan);
    if (!library->count)
        return true;
    csg_mtl_material *material = &library->materials[library->count - 1];
    if (csg_scan_is(word, length, "kd"))
        read_color(material, scan);
    else if (csg_scan_is(word, length, "d") || csg_scan_is(word, length, "tr"))
        read_opacity(material, scan, length == 2);
    else if (csg_scan_is(word, length, "pm") || csg_scan_is(word, length, "pr"))
        read_finish(material, scan, word[1] == 'r' || word[1] == 'R');
    library->has_pictures |= length > 4 && csg_scan_is(word, 4, "map_");
    return true;
}

static bool read_materials(csg_mtl_library *library, const csg_input *input)
{
    csg_text_scan scan = csg_scan_start(input);
    for (;;) {
        csg_scan_space(&scan);
        if (scan.at == scan.end)
            return true;
        if (!read_line(library, &scan))
            return false;
        csg_scan_skip_line(&scan);
    }
}

/* ---- all of them ----------------------------------------------------------------------------- */

static int by_name(const void *a, const void *b)
{
    const csg_mtl_entry *x = a, *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : (x->index > y->index) - (x->index < y->index);
}

/* -1: there is no such file that one may read. The caller closes it. */
static int open_file(const csg_input *input, const char *name)
{
    struct stat about;
    int fd = input->companion ? dup(*input->companion)
                              : csg_open_beside(input->context, input->path, name);
    if (fd < 0 || (fstat(fd, &about) == 0 && S_ISREG(about.st_mode)))
        return fd;
    close(fd);
    return -1;
}

csgm_status csg_mtl_read(csg_input *input, const char *name, csg_mtl_library *library)
{
    csgm_context *context = input->context;
    csg_input file = {.context = context, .path = name};
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (++library->file_count > MOST_FILES)
        return csg_read_unsupported(input, "more than %d files of materials", MOST_FILES);
    int fd = open_file(input, name);
    if (fd < 0) {
        library->is_missing = true;
        return CSGM_OK;
    }
    csgm_status status = csg_input_load(context, name, fd, &bytes, &size);
    close(fd);
    if (status)
        return status;
    file.bytes = bytes;
    file.size_bytes = size;
    bool done = read_materials(library, &file);
    csg_memory_release(&context->memory, bytes, size);
    if (!done)
        return csg_context_no_memory(context);
    if (library->count)
        qsort(library->sorted, library->count, sizeof *library->sorted, by_name);
    return CSGM_OK;
}

int64_t csg_mtl_find(const csg_mtl_library *library, const char *name, size_t length)
{
    size_t low = 0, high = library->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const char *at = library->sorted[middle].name;
        size_t own = strlen(at), both = own < length ? own : length;
        int order = memcmp(at, name, both);
        if (!order)
            order = (own > length) - (own < length);
        if (!order)
            return library->sorted[middle].index;
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return -1;
}
