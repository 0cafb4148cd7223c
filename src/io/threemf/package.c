/* SPDX-License-Identifier: MIT
 * The only file that names libzip and expat: a ZIP package in memory -> the elements of one of its
 * XML files, or XML in memory -> its elements. Bytes are hostile, so: what comes out of the archive
 * may be so many times as much as went in and no more, a single tag has a length that it may not
 * exceed, elements may not nest without end, and there are no document type declarations, hence no
 * entities to expand.
 */
#include <expat.h>
#include <stdio.h>
#include <stdlib.h>
#include <zip.h>

#include "io/adapter.h"

enum {
    CHUNK = 1 << 16,
    MOST_TAG_BYTES = 1 << 20,
    MOST_DEPTH = 64,
    MOST_RATIO = 100,     /* text to archive; meshes have 3 to 20 */
    FREE_BYTES = 16 << 20 /* that any archive may unpack to */
};

struct csg_package {
    zip_t *archive;
    uint64_t bytes_left; /* that may still come out */
    char error[200];
};

typedef struct parse {
    XML_Parser parser;
    const csg_xml_calls *calls;
    csgm_status status; /* of the calls */
    const char *problem;
    uint64_t fed, seen; /* bytes given to the parser, and at its last sign of life */
    uint32_t depth;
} parse;

static csgm_status fail(csg_adapter_error *error, csgm_status status, const char *what,
                        const char *name, const char *why)
{
    snprintf(error->text, sizeof error->text, "%s%.80s%s%.120s", what, name, *why ? ": " : "", why);
    return status;
}

bool csg_package_available(void)
{
    return true;
}

csgm_status csg_package_open(const uint8_t *bytes, size_t size_bytes, csg_package **out,
                             csg_adapter_error *error)
{
    zip_error_t problem;
    zip_error_init(&problem);
    csg_package *package = calloc(1, sizeof *package);
    zip_source_t *source = zip_source_buffer_create(bytes, size_bytes, 0, &problem);
    if (!package || !source) {
        free(package);
        zip_source_free(source);
        zip_error_fini(&problem);
        return fail(error, CSGM_ERR_MEMORY, "out of memory", "", "");
    }
    package->archive = zip_open_from_source(source, ZIP_RDONLY, &problem);
    package->bytes_left = FREE_BYTES + MOST_RATIO * (uint64_t)size_bytes;
    if (package->archive) {
        *out = package;
        return CSGM_OK;
    }
    fail(error, CSGM_ERR_FORMAT, "the file is no ZIP package", "", zip_error_strerror(&problem));
    csgm_status status =
        zip_error_code_zip(&problem) == ZIP_ER_MEMORY ? CSGM_ERR_MEMORY : CSGM_ERR_FORMAT;
    zip_source_free(source);
    zip_error_fini(&problem);
    free(package);
    return status;
}

void csg_package_close(csg_package *package)
{
    if (!package)
        return;
    zip_discard(package->archive);
    free(package);
}

/* ---- elements -------------------------------------------------------------------------------- */

static void stop(parse *p, csgm_status status, const char *problem)
{
    if (p->status == CSGM_OK) {
        p->status = status;
        p->problem = problem;
        XML_StopParser(p->parser, XML_FALSE);
    }
}

static void XMLCALL on_start(void *user, const char *name, const char **attributes)
{
    parse *p = user;
    p->seen = p->fed;
    if (p->status != CSGM_OK)
        return;
    if (++p->depth > MOST_DEPTH) {
        stop(p, CSGM_ERR_FORMAT, "its elements are nested too deeply");
        return;
    }
    csgm_status status = p->calls->start(p->calls->user, name, attributes);
    if (status != CSGM_OK)
        stop(p, status, "");
}

static void XMLCALL on_namespace(void *user, const char *prefix, const char *space)
{
    parse *p = user;
    if (p->status != CSGM_OK || !p->calls->declare || !prefix || !space)
        return;
    csgm_status status = p->calls->declare(p->calls->user, prefix, space);
    if (status != CSGM_OK)
        stop(p, status, "");
}

static void XMLCALL on_end(void *user, const char *name)
{
    parse *p = user;
    p->seen = p->fed;
    p->depth--;
    if (p->status != CSGM_OK)
        return;
    csgm_status status = p->calls->end(p->calls->user, name);
    if (status != CSGM_OK)
        stop(p, status, "");
}

static void XMLCALL on_other(void *user, const char *text, int length)
{
    parse *p = user;
    (void)text, (void)length;
    p->seen = p->fed;
}

static void XMLCALL on_text(void *user, const char *text, int length)
{
    parse *p = user;
    p->seen = p->fed;
    if (p->status != CSGM_OK || !p->calls->text)
        return;
    csgm_status status = p->calls->text(p->calls->user, text, (size_t)length);
    if (status != CSGM_OK)
        stop(p, status, "");
}

static void XMLCALL on_doctype(void *user, const char *name, const char *system_id,
                               const char *public_id, int internal)
{
    (void)name, (void)system_id, (void)public_id, (void)internal;
    stop(user, CSGM_ERR_FORMAT, "it has a document type declaration, which is not read");
}

/* ---- bytes ----------------------------------------------------------------------------------- */

static csgm_status fail_parser(parse *p)
{
    enum XML_Error code = XML_GetErrorCode(p->parser);
    if (p->status != CSGM_OK)
        return p->status;
    p->problem = XML_ErrorString(code);
    return code == XML_ERROR_NO_MEMORY ? CSGM_ERR_MEMORY : CSGM_ERR_FORMAT;
}

static bool make_parser(parse *p)
{
    p->parser = XML_ParserCreateNS(NULL, '|');
    if (!p->parser)
        return false;
    XML_SetUserData(p->parser, p);
    XML_SetElementHandler(p->parser, on_start, on_end);
    XML_SetStartNamespaceDeclHandler(p->parser, on_namespace);
    XML_SetDefaultHandler(p->parser, on_other);
    XML_SetCharacterDataHandler(p->parser, on_text);
    XML_SetStartDoctypeDeclHandler(p->parser, on_doctype);
    return true;
}

/* Of a parse that has ended so. */
static csgm_status tell(parse *p, csgm_status status, const char *what, const char *name,
                        csg_adapter_error *error)
{
    bool reported = p->status != CSGM_OK && !*p->problem;
    if (status == CSGM_ERR_MEMORY && !reported)
        p->problem = "out of memory";
    if (status != CSGM_OK && !reported)
        fail(error, status, what, name, p->problem);
    XML_ParserFree(p->parser);
    return status;
}

static csgm_status feed(csg_package *package, zip_file_t *file, parse *p)
{
    for (;;) {
        void *buffer = XML_GetBuffer(p->parser, CHUNK);
        if (!buffer)
            return CSGM_ERR_MEMORY;
        zip_int64_t got = zip_fread(file, buffer, CHUNK);
        if (got < 0) {
            p->problem = zip_file_strerror(file);
            return CSGM_ERR_FORMAT;
        }
        if ((uint64_t)got > package->bytes_left) {
            p->problem = "it unpacks to more than a mesh ever would";
            return CSGM_ERR_FORMAT;
        }
        package->bytes_left -= (uint64_t)got;
        p->fed += (uint64_t)got;
        if (XML_ParseBuffer(p->parser, (int)got, got == 0) != XML_STATUS_OK)
            return fail_parser(p);
        if (p->fed - p->seen > MOST_TAG_BYTES) {
            p->problem = "it has a tag of more than a megabyte";
            return CSGM_ERR_FORMAT;
        }
        if (got == 0)
            return CSGM_OK;
    }
}

csgm_status csg_package_parse(csg_package *package, const char *name, const csg_xml_calls *calls,
                              csg_adapter_error *error)
{
    parse p = {.calls = calls, .problem = ""};
    zip_int64_t index = zip_name_locate(package->archive, name, ZIP_FL_NOCASE);
    if (index < 0)
        return fail(error, CSGM_ERR_FORMAT, "the package has no ", name, "");
    zip_file_t *file = zip_fopen_index(package->archive, (zip_uint64_t)index, 0);
    if (!file)
        return fail(error, CSGM_ERR_FORMAT, "in the package's ", name,
                    zip_strerror(package->archive));
    csgm_status status = make_parser(&p) ? feed(package, file, &p) : CSGM_ERR_MEMORY;
    status = tell(&p, status, "in the package's ", name, error); /* the problem may be the file's */
    zip_fclose(file);
    return status;
}

const char *csg_package_first(csg_package *package)
{
    return zip_get_num_entries(package->archive, 0) > 0 ? zip_get_name(package->archive, 0, 0)
                                                        : NULL;
}

csgm_status csg_package_parse_bytes(const uint8_t *bytes, size_t size_bytes,
                                    const csg_xml_calls *calls, csg_adapter_error *error)
{
    parse p = {.calls = calls, .problem = ""};
    csgm_status status = make_parser(&p) ? CSGM_OK : CSGM_ERR_MEMORY;
    for (size_t at = 0, chunk = CHUNK; status == CSGM_OK && at <= size_bytes; at += chunk) {
        bool last = size_bytes - at <= CHUNK;
        chunk = last ? size_bytes - at : CHUNK;
        p.fed += chunk;
        if (XML_Parse(p.parser, (const char *)bytes + at, (int)chunk, last) != XML_STATUS_OK)
            status = fail_parser(&p);
        else if (p.fed - p.seen > MOST_TAG_BYTES) {
            p.problem = "it has a tag of more than a megabyte";
            status = CSGM_ERR_FORMAT;
        }
        if (last)
            break;
    }
    return tell(&p, status, "in the file", "", error);
}
