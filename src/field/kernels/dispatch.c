/* SPDX-License-Identifier: MIT
 * The builds of kernel.c in this program, narrowest first.
 */
#include "field/kernels/dispatch.h"

#ifdef CSG_HAVE_KERNEL_scalar
extern const csg_kernel csg_kernel_scalar;
#define NARROWEST csg_kernel_scalar
#else
#define NARROWEST csg_kernel_simd128
#endif
#ifdef CSG_HAVE_KERNEL_sse2
extern const csg_kernel csg_kernel_sse2;
#endif
#ifdef CSG_HAVE_KERNEL_avx2
extern const csg_kernel csg_kernel_avx2;
#endif
#ifdef CSG_HAVE_KERNEL_avx512
extern const csg_kernel csg_kernel_avx512;
#endif
#ifdef CSG_HAVE_KERNEL_neon
extern const csg_kernel csg_kernel_neon;
#endif
#ifdef CSG_HAVE_KERNEL_simd128
extern const csg_kernel csg_kernel_simd128;
#endif

static bool cpu_has(csgm_isa isa)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    switch (isa) {
    case CSGM_ISA_SSE2:
        return __builtin_cpu_supports("sse2");
    case CSGM_ISA_AVX2:
        return __builtin_cpu_supports("avx2");
    case CSGM_ISA_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    default:
        return false;
    }
#else
    return isa == CSGM_ISA_NEON || isa == CSGM_ISA_SIMD128; /* every machine of their kind */
#endif
}

/* The build of an instruction set, NULL where this program has none. */
static const csg_kernel *kernel_of(csgm_isa isa)
{
    switch (isa) {
#ifdef CSG_HAVE_KERNEL_scalar
    case CSGM_ISA_SCALAR:
        return &csg_kernel_scalar;
#endif
#ifdef CSG_HAVE_KERNEL_sse2
    case CSGM_ISA_SSE2:
        return &csg_kernel_sse2;
#endif
#ifdef CSG_HAVE_KERNEL_avx2
    case CSGM_ISA_AVX2:
        return &csg_kernel_avx2;
#endif
#ifdef CSG_HAVE_KERNEL_avx512
    case CSGM_ISA_AVX512:
        return &csg_kernel_avx512;
#endif
#ifdef CSG_HAVE_KERNEL_neon
    case CSGM_ISA_NEON:
        return &csg_kernel_neon;
#endif
#ifdef CSG_HAVE_KERNEL_simd128
    case CSGM_ISA_SIMD128:
        return &csg_kernel_simd128;
#endif
    default:
        return NULL;
    }
}

static bool is_usable(csgm_isa isa)
{
    return kernel_of(isa) && (isa == CSGM_ISA_SCALAR || cpu_has(isa));
}

csgm_isa csg_cpu_best_isa(csgm_isa wanted)
{
    if (wanted != CSGM_ISA_AUTO && is_usable(wanted))
        return wanted;
    static const csgm_isa widest_first[] = {CSGM_ISA_AVX512, CSGM_ISA_AVX2, CSGM_ISA_SSE2,
                                            CSGM_ISA_NEON, CSGM_ISA_SIMD128};
    for (size_t i = 0; i < sizeof widest_first / sizeof *widest_first; i++)
        if (is_usable(widest_first[i]))
            return widest_first[i];
    return CSGM_ISA_SCALAR;
}

const csg_kernel *csg_kernel_for(csgm_isa isa)
{
    const csg_kernel *kernel = kernel_of(isa);
    return kernel ? kernel : &NARROWEST;
}

const char *csg_isa_name(csgm_isa isa)
{
    return csg_kernel_for(isa)->name;
}

size_t csg_kernel_scratch_floats(uint32_t depth)
{
    enum { MOST_FLOATS = 1 << 20 };
    size_t whole = csg_kernel_arrays(depth) * CSG_BATCH;
    size_t least = CSG_KERNEL_WALKS * csg_kernel_arrays(depth) * CSG_LANES;
    if (whole <= MOST_FLOATS)
        return whole;
    return least > MOST_FLOATS ? least : (size_t)MOST_FLOATS;
}
