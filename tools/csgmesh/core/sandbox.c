/* SPDX-License-Identifier: MIT
 * The sandbox, and a fence around all memory; see sandbox.h.
 *
 * --sandbox is a filter of system calls (seccomp, Linux 3.5) that every thread has from here on.
 * Refused, with EPERM: sockets of any kind and io_uring, which makes them too; starting programs;
 * signals to and looks into other processes; namespaces, mounts, keys, modules, tracing. Files are
 * not its business: --root sees to them.
 *
 * The fence: a context counts the memory that it takes itself, but not what libraries take that
 * read fonts, pictures, Draco and so on. So the kernel is told how much the process may have at
 * all: the limit of the contexts, and some beside it.
 */
#include "core/sandbox.h"

#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/options.h"
#include "core/roots.h"

#if defined(__linux__) && __has_include(<linux/seccomp.h>) && __has_include(<linux/filter.h>)
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#if defined(__x86_64__)
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#elif defined(__riscv) && __riscv_xlen == 64 && defined(AUDIT_ARCH_RISCV64)
#define ARCHITECTURE AUDIT_ARCH_RISCV64
#endif
#endif

#ifdef ARCHITECTURE
/* Calls by numbers that are the same on all architectures where old headers have no name. */
#ifndef SYS_io_uring_setup
#define SYS_io_uring_setup 425
#endif
#ifndef SYS_pidfd_open
#define SYS_pidfd_open 434
#endif
#ifndef SYS_pidfd_getfd
#define SYS_pidfd_getfd 438
#endif

/* clang-format off */
static const int refused[] = {
    SYS_socket, SYS_socketpair, SYS_bind, SYS_connect, SYS_listen, SYS_accept, SYS_accept4,
    SYS_sendto, SYS_sendmsg, SYS_sendmmsg, SYS_io_uring_setup,
    SYS_execve, SYS_execveat,
    SYS_ptrace, SYS_process_vm_readv, SYS_process_vm_writev, SYS_pidfd_open, SYS_pidfd_getfd, SYS_kcmp,
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, SYS_unshare, SYS_setns,
    SYS_bpf, SYS_perf_event_open, SYS_userfaultfd, SYS_add_key, SYS_request_key, SYS_keyctl,
    SYS_init_module, SYS_finit_module, SYS_delete_module, SYS_kexec_load, SYS_swapon, SYS_swapoff,
    SYS_reboot, SYS_settimeofday, SYS_clock_settime, SYS_sethostname, SYS_setdomainname, SYS_acct,
    SYS_msgget, SYS_semget, SYS_shmget, SYS_mq_open,
};
/* clang-format on */
enum { REFUSED = sizeof refused / sizeof *refused };

/* Signals to others; the process may send itself what abort() does. */
static const int signals[] = {SYS_kill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo};
enum { SIGNALS = sizeof signals / sizeof *signals };

static void load(struct sock_filter **at, size_t offset)
{
    *(*at)++ = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)offset);
}

static void give(struct sock_filter **at, uint32_t outcome)
{
    *(*at)++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, outcome);
}

/* What follows is for this value alone: others jump over `length` instructions. */
static void only_for(struct sock_filter **at, uint32_t value, uint8_t length)
{
    *(*at)++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, length);
}

/* The program of the filter; its length. */
static size_t write_filter(struct sock_filter *filter)
{
    const uint32_t no = SECCOMP_RET_ERRNO | EPERM;
    const size_t number = offsetof(struct seccomp_data, nr);
    struct sock_filter *at = filter;
    load(&at, offsetof(struct seccomp_data, arch));
    *at++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
    give(&at, no); /* the calls of another architecture, as of 32 bits */
    load(&at, number);
#ifdef __X32_SYSCALL_BIT
    *at++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, __X32_SYSCALL_BIT, 0, 1);
    give(&at, no);
#endif
    for (size_t i = 0; i < REFUSED; i++) {
        only_for(&at, (uint32_t)refused[i], 1);
        give(&at, no);
    }
    for (size_t i = 0; i < SIGNALS; i++) {
        only_for(&at, (uint32_t)signals[i], 4);
        load(&at,
             offsetof(struct seccomp_data, args)); /* the process; its lower half: little end */
        only_for(&at, (uint32_t)getpid(), 1);
        give(&at, SECCOMP_RET_ALLOW);
        give(&at, no);
    }
    give(&at, SECCOMP_RET_ALLOW);
    return (size_t)(at - filter);
}

static const char *enter(void)
{
    struct sock_filter filter[16 + 2 * REFUSED + 5 * SIGNALS];
    struct sock_fprog program = {.filter = filter, .len = (unsigned short)write_filter(filter)};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0)
        return NULL;
    return errno == EINVAL ? "this kernel has no seccomp filters" : strerror(errno);
}
#else
static const char *enter(void)
{
    return "it needs Linux on x86-64, ARM64 or RISC-V 64";
}
#endif

static bool is_wanted(const cli_app *app)
{
    const char *environment = getenv("CSGMESH_SANDBOX");
    return app->options->sandbox || (environment && *environment && strcmp(environment, "0") != 0);
}

/* ---- the fence --------------------------------------------------------------------------------
 */

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/* What the process has now of what the limit counts: private memory that can be written. 0: not
 * known. */
static uint64_t data_now(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file)
        return 0;
    if (fscanf(file, "%*u %*u %*u %*u %*u %llu", &pages) != 1) // NOLINT(cert-err34-c)
        pages = 0;
    fclose(file);
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static void fence_memory(const cli_app *app)
{
    const uint64_t of_thread = (uint64_t)10 << 20; /* its stack, above all */
    const uint64_t of_libraries = (uint64_t)64 << 20;
    const cli_options *options = app->options;
    uint64_t most = options->given[CLI_OPTION_max_memory]
                        ? options->max_memory
                        : csgm_context_options_default().limits.memory_bytes;
    uint64_t before = data_now();
    uint64_t cores = (uint64_t)sysconf(_SC_NPROCESSORS_ONLN);
    uint64_t threads = options->threads ? options->threads : cores;
    uint64_t jobs = options->command == CLI_BATCH ? threads : 1;
    struct rlimit limit;
    if (!most || !before || most > UINT64_MAX / 4 / (jobs ? jobs : 1) ||
        getrlimit(RLIMIT_DATA, &limit) != 0)
        return;
    uint64_t whole = before + jobs * most + of_libraries + (threads + 2) * of_thread;
    if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > whole) {
        limit.rlim_cur = (rlim_t)whole;
        setrlimit(RLIMIT_DATA, &limit);
    }
}
#else
static void fence_memory(const cli_app *app)
{
    (void)app; /* elsewhere the limit counts other things; sanitizers have memory of their own */
}
#endif

int cli_confine(cli_app *app)
{
    fence_memory(app);
    int status = cli_roots_confine(app);
    const char *reason = status == CLI_DONE && is_wanted(app) ? enter() : NULL;
    if (!reason)
        return status;
    return cli_usage_error(app, "run it in a container without a network instead",
                           "--sandbox cannot be kept here: %s", reason);
}
