constexpr int kLanes = 2;
#include "prowl/kernels/dense_kernels_code.inc"

const prowl::DenseKernels prowl::kernels_x86_64 = prowl::all_kernels("x86-64");
