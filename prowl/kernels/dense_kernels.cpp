#include "prowl/kernels/dense_kernels.hpp"

#ifdef __x86_64__
#ifdef __clang__
#define _Bool bool  // a header in C, whose type GCC knows in C++ too
#endif
#include <sys/platform/x86.h>
#endif

namespace prowl {

const DenseKernels& dense_kernels() {
#ifdef __x86_64__
  // The loader's view of the processor, which GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2 masks: a test of both paths needs
  // no second machine.
  static const bool has_v3 = CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(FMA);
  if (has_v3) return kernels_x86_64_v3;
#endif
  return kernels_x86_64;
}

}  // namespace prowl
