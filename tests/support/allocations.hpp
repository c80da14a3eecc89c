#pragma once

#include <atomic>
#include <cstddef>

/// Counts allocations. In one source file of a program only: it defines malloc.
///
/// Every allocation of the process comes by here, those of operator new and of Eigen in Prowl's and Pinocchio's
/// libraries too: what a program defines goes before what libraries do. glibc keeps the real ones under these names.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PROWL_COUNTS_ALLOCATIONS

namespace prowl::test {
inline std::atomic<long> allocations{0};
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++prowl::test::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++prowl::test::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++prowl::test::allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++prowl::test::allocations;
  return __libc_memalign(alignment, size);
}
}
#endif
