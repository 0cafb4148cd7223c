/* SPDX-License-Identifier: MIT
 * nlohmann's JSON as a stream of events; see json.h. Its event parser does not recurse and keeps no
 * more than the brackets that are open, so depth and size are the caller's to bound.
 */
#include "text/json.h"

#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include <nlohmann/json.hpp>

namespace
{

using nlohmann::json;

/* "[json.exception...] parse error at line 1, column 2: what is wrong" */
void describe(size_t position, const json::exception &problem, csg_json_error *error)
{
    const char *text = problem.what();
    const char *colon = std::strstr(text, ": ");
    std::snprintf(error->text, sizeof error->text, "%s", colon ? colon + 2 : text);
    error->offset = position > 0 ? position - 1 : 0;
}

struct stream {
    csg_json_fn *event;
    void *user;
    csg_json_error *error;
    bool broken = false;

    bool tell(csg_json_kind kind, const char *text, size_t length)
    {
        return event(user, kind, text, length);
    }
    bool tell(csg_json_kind kind, const std::string &text)
    {
        return tell(kind, text.data(), text.size());
    }

    /* nlohmann's names for the events */
    bool null()
    {
        return tell(CSG_JSON_WORD, "null", 4);
    }
    bool boolean(bool value)
    {
        return value ? tell(CSG_JSON_WORD, "true", 4) : tell(CSG_JSON_WORD, "false", 5);
    }
    bool number_integer(json::number_integer_t value)
    {
        return tell(CSG_JSON_NUMBER, std::to_string(value));
    }
    bool number_unsigned(json::number_unsigned_t value)
    {
        return tell(CSG_JSON_NUMBER, std::to_string(value));
    }
    bool number_float(json::number_float_t, const std::string &text)
    {
        return tell(CSG_JSON_NUMBER, text);
    }
    bool string(std::string &value)
    {
        return tell(CSG_JSON_STRING, value);
    }
    bool binary(json::binary_t &)
    {
        return false; /* not in text */
    }
    bool start_object(size_t)
    {
        return tell(CSG_JSON_OBJECT, "", 0);
    }
    bool key(std::string &value)
    {
        return tell(CSG_JSON_KEY, value);
    }
    bool end_object()
    {
        return tell(CSG_JSON_END, "", 0);
    }
    bool start_array(size_t)
    {
        return tell(CSG_JSON_ARRAY, "", 0);
    }
    bool end_array()
    {
        return tell(CSG_JSON_END, "", 0);
    }

    bool parse_error(size_t position, const std::string &, const json::exception &problem)
    {
        describe(position, problem, error);
        broken = true;
        return false;
    }
};

} // namespace

bool csg_json_available(void)
{
    return true;
}

csg_json_outcome csg_json_read(const char *text, size_t length, csg_json_fn *event, void *user,
                               csg_json_error *error)
{
    stream events{event, user, error};
    *error = csg_json_error{};
    try {
        if (json::sax_parse(text, text + length, &events))
            return CSG_JSON_DONE;
        return events.broken ? CSG_JSON_BROKEN : CSG_JSON_STOPPED;
    } catch (const std::bad_alloc &) {
        return CSG_JSON_NO_MEMORY;
    } catch (const std::exception &problem) { /* a number out of every range, say */
        std::snprintf(error->text, sizeof error->text, "%s", problem.what());
        return CSG_JSON_BROKEN;
    }
}
