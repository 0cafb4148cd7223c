/* SPDX-License-Identifier: MIT
 * One call into libcsgmesh as Python sees it. A context is made for each call and lives on with
 * what was made with it. The work is done on a thread of its own while the calling thread waits,
 * looks for Ctrl-C, and calls back into Python: so the GIL is free, and a call can be left at any
 * moment at which libcsgmesh asks whether it shall go on.
 */
#ifndef CSGMESH_PYTHON_CONTEXT_H
#define CSGMESH_PYTHON_CONTEXT_H

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "csgmesh/csgmesh.h"

namespace nb = nanobind;

/* A csgm_diag that outlives its callback. */
struct Finding {
    csgm_severity severity;
    uint16_t code;
    std::optional<std::string> source, hint, library, source_line;
    uint32_t line, column, length, end_line, end_column;
    bool lenient;
    std::string message, text; /* text: as the command line prints it */
};

class Context
{
  public:
    /* settings: the members of csgm_context_options and csgm_limits that Python may set. */
    explicit Context(nb::dict settings);
    ~Context();
    Context(const Context &) = delete;
    Context &operator=(const Context &) = delete;

    csgm_context *get() const
    {
        return context_;
    }
    /* For csgm_..._options.monitor. */
    csgm_monitor monitor();
    /* Does the work without the GIL; progress and echo are called meanwhile, on this thread. Throws
     * what these raise, KeyboardInterrupt too, when the work has stopped. */
    csgm_status work(nb::handle progress, nb::handle echo,
                     const std::function<csgm_status()> &work);

    csgm_status status = CSGM_OK; /* of the start */
    std::vector<Finding> findings;

  private:
    void keep_finding(const csgm_diag *diag);
    void lose() noexcept;
    static void take_finding(void *user, const csgm_diag *diag);
    static void take_echo(void *user, const char *text, size_t length);
    static void take_progress(void *user, csgm_stage stage, double fraction);
    static bool is_cancelled(void *user);
    void attend(nb::handle progress, nb::handle echo);
    void call_back(nb::handle progress, nb::handle echo);
    void wait(std::thread &worker, nb::handle progress, nb::handle echo);

    csgm_context *context_ = nullptr;
    std::atomic<bool> cancelled_{false};
    std::atomic<bool> no_memory_{false}; /* for a finding or an echo */
    std::mutex mutex_;                   /* of what follows */
    std::condition_variable changed_;
    bool done_ = false, has_progress_ = false;
    csgm_stage stage_ = CSGM_STAGE_OCTREE;
    double fraction_ = 0;
    std::string echoes_;
    std::optional<nb::python_error> error_; /* with the GIL only */
};

using ContextPointer = std::shared_ptr<Context>;

/* What Python holds of one call: its context, and whom to call back. */
struct Run {
    ContextPointer context;
    nb::object progress, echo;

    csgm_status work(const std::function<csgm_status()> &what) const
    {
        return context->status != CSGM_OK ? context->status : context->work(progress, echo, what);
    }
};

void define_context(nb::module_ &module);

#endif
