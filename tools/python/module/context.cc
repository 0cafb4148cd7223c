/* SPDX-License-Identifier: MIT
 * Calls, findings and Ctrl-C; see context.h.
 */
#include "module/context.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <chrono>
#include <iterator>
#include <system_error>

#include "module/options.h"

namespace
{

constexpr auto LOOK_EACH = std::chrono::milliseconds(50);

const char *const stage_names[] = {"octree",  "mesh",    "write",   "render",
                                   "reshape", "certify", "compare", "measure"};
static_assert(std::size(stage_names) == CSGM_STAGE_COUNT, "a name for each csgm_stage");
const char *const severity_names[] = {"note", "warning", "error"};

std::optional<std::string> copy(const char *text)
{
    return text ? std::optional<std::string>(text) : std::nullopt;
}

/* Text of files may be no UTF-8. */
nb::object to_python(const std::optional<std::string> &text)
{
    if (!text)
        return nb::none();
    return nb::steal(PyUnicode_DecodeUTF8(text->data(), (Py_ssize_t)text->size(), "replace"));
}

nb::dict describe(const Finding &f)
{
    nb::dict out;
    out["severity"] = severity_names[f.severity];
    out["number"] = f.code;
    out["file"] = to_python(f.source);
    out["line"] = f.line;
    out["column"] = f.column;
    out["length"] = f.length;
    out["end_line"] = f.end_line;
    out["end_column"] = f.end_column;
    out["message"] = to_python(f.message);
    out["hint"] = to_python(f.hint);
    out["source_line"] = to_python(f.source_line);
    out["library"] = to_python(f.library);
    out["lenient"] = f.lenient;
    out["text"] = to_python(f.text);
    return out;
}

} // namespace

/* ---- what libcsgmesh calls, without the GIL ---------------------------------------------------- */

void Context::keep_finding(const csgm_diag *diag)
{
    Finding f{diag->severity,
              diag->code,
              copy(diag->source_name),
              copy(diag->hint),
              copy(diag->library),
              std::nullopt,
              diag->line,
              diag->column,
              diag->length,
              diag->end_line,
              diag->end_column,
              diag->lenient,
              diag->message,
              ""};
    if (diag->source_line)
        f.source_line.emplace(diag->source_line, diag->source_line_length);
    f.text.resize(csgm_diag_format(diag, nullptr, 0));
    csgm_diag_format(diag, f.text.data(), f.text.size() + 1);
    findings.push_back(std::move(f));
}

/* Nothing may be thrown through C: the work stops, and the call ends without memory. */
void Context::lose() noexcept
{
    no_memory_ = true;
    cancelled_ = true;
}

void Context::take_finding(void *user, const csgm_diag *diag)
{
    auto *self = static_cast<Context *>(user);
    try {
        self->keep_finding(diag);
    } catch (const std::exception &) {
        self->lose();
    }
}

void Context::take_echo(void *user, const char *text, size_t length)
{
    auto *self = static_cast<Context *>(user);
    try {
        std::lock_guard<std::mutex> lock(self->mutex_);
        self->echoes_.append(text, length);
    } catch (const std::exception &) {
        self->lose();
    }
}

void Context::take_progress(void *user, csgm_stage stage, double fraction)
{
    auto *self = static_cast<Context *>(user);
    std::lock_guard<std::mutex> lock(self->mutex_);
    self->has_progress_ = true;
    self->stage_ = stage;
    self->fraction_ = fraction;
}

bool Context::is_cancelled(void *user)
{
    return static_cast<Context *>(user)->cancelled_.load(std::memory_order_relaxed);
}

/* ---- the context ------------------------------------------------------------------------------- */

Context::Context(nb::dict settings)
{
    csgm_context_options options = csgm_context_options_default();
    fill_context_options(options, settings);
    options.on_diag = take_finding;
    options.on_echo = take_echo;
    options.cancelled = is_cancelled;
    options.user = this;
    status = csgm_context_create(&options, &context_);
}

Context::~Context()
{
    csgm_context_destroy(context_);
}

csgm_monitor Context::monitor()
{
    csgm_monitor monitor{};
    monitor.progress = take_progress;
    monitor.user = this;
    return monitor;
}

/* ---- a call ------------------------------------------------------------------------------------ */

/* With the GIL. */
void Context::call_back(nb::handle progress, nb::handle echo)
{
    std::string echoes;
    bool has_progress;
    csgm_stage stage;
    double fraction;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        echoes.swap(echoes_);
        has_progress = has_progress_;
        has_progress_ = false;
        stage = stage_;
        fraction = fraction_;
    }
    if (!echoes.empty() && !echo.is_none())
        echo(to_python(echoes));
    if (has_progress && !progress.is_none())
        progress(stage_names[stage], fraction);
}

/* With the GIL. The first that goes wrong stops the work, and is thrown when it has stopped. */
void Context::attend(nb::handle progress, nb::handle echo)
{
    if (error_)
        return;
    try {
        if (PyErr_CheckSignals() != 0)
            throw nb::python_error();
        call_back(progress, echo);
    } catch (nb::python_error &error) {
        error_.emplace(std::move(error));
        cancelled_ = true;
    } catch (const std::exception &error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
        error_.emplace();
        cancelled_ = true;
    }
}

/* Without the GIL, until the worker has ended. */
void Context::wait(std::thread &worker, nb::handle progress, nb::handle echo)
{
    std::unique_lock<std::mutex> lock(mutex_);
    while (!changed_.wait_for(lock, LOOK_EACH, [this] { return done_; })) {
        lock.unlock();
        {
            nb::gil_scoped_acquire python;
            attend(progress, echo);
        }
        lock.lock();
    }
    lock.unlock();
    worker.join();
}

csgm_status Context::work(nb::handle progress, nb::handle echo,
                          const std::function<csgm_status()> &what)
{
    csgm_status result = CSGM_ERR_MEMORY;
    done_ = false;
    {
        nb::gil_scoped_release others;
        std::thread worker;
        try {
            worker = std::thread([&] {
                result = what();
                std::lock_guard<std::mutex> lock(mutex_);
                done_ = true;
                changed_.notify_one();
            });
        } catch (const std::system_error &) { /* there are no more threads */
            result = what();
        }
        if (worker.joinable())
            wait(worker, progress, echo);
        csgm_context_rest(context_);
    }
    attend(progress, echo);
    cancelled_ = false;
    if (no_memory_.exchange(false))
        result = CSGM_ERR_MEMORY;
    if (error_) {
        nb::python_error error(std::move(*error_));
        error_.reset();
        throw error;
    }
    return result;
}

/* ---- Python ------------------------------------------------------------------------------------ */

void define_context(nb::module_ &module)
{
    nb::class_<Run>(module, "Run", "One call into libcsgmesh: its context and whom it calls back.")
        .def(
            "__init__",
            [](Run *self, nb::dict settings, nb::object progress, nb::object echo) {
                new (self) Run{std::make_shared<Context>(settings), progress, echo};
            },
            nb::arg("settings"), nb::arg("progress").none(), nb::arg("echo").none())
        .def_prop_ro("findings", [](const Run &run) {
            nb::list out;
            for (const Finding &f : run.context->findings)
                out.append(describe(f));
            return out;
        });
}
