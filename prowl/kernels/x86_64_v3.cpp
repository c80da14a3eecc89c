// Compiled with AVX2 and FMA where the compiler knows them.
#ifdef __AVX2__
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif
#include "prowl/kernels/dense_kernels_code.inc"

const prowl::DenseKernels prowl::kernels_x86_64_v3 = prowl::all_kernels("x86-64-v3");
