# Vector instructions. Baseline x86-64 has SSE2, whose vectors are as long as malloc's alignment: results do not depend on where
# memory lies. With avx2 (10 to 25 % less time) their last digits do. "auto" is avx2 if the machine that builds has it.
set(PROWL_SIMD "baseline" CACHE STRING "baseline, avx2 or auto")
set_property(CACHE PROWL_SIMD PROPERTY STRINGS baseline avx2 auto)
if(PROWL_SIMD STREQUAL "auto")
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }"
    PROWL_MACHINE_HAS_AVX2)
  if(PROWL_MACHINE_HAS_AVX2)
    set(PROWL_SIMD avx2)
  else()
    set(PROWL_SIMD baseline)
  endif()
elseif(NOT PROWL_SIMD MATCHES "^(avx2|baseline)$")
  message(FATAL_ERROR "PROWL_SIMD is ${PROWL_SIMD}: need auto, avx2 or baseline")
endif()
message(STATUS "Prowl: vector instructions: ${PROWL_SIMD}")

# Files and text take no time of a solve. GCC 12 compiles them in two thirds of the time with -O1.
set(PROWL_LIGHT_OPTIONS $<$<CONFIG:Release>:-O1>)

# prowl_layer(<name> [FAST|LIGHT] [INTERNAL] [FOLDER folder] [WITHOUT files of other targets] DEPENDS <layers and public libraries> PRIVATE <libraries that its headers do not show>)
# One library a folder, so that the linker too refuses an include against the direction of the layers. FOLDER: <name>, in the
# folder of the caller, if not said otherwise.
# INTERNAL: used by the command and the Python package only; its headers and target are not installed.
# FAST: most of the time of a solve is spent there; compiled for ${PROWL_SIMD}. LIGHT: no numerics; compiled with -O1.
function(prowl_layer name)
  cmake_parse_arguments(ARG "FAST;LIGHT;INTERNAL" "FOLDER" "DEPENDS;PRIVATE;WITHOUT" ${ARGN})
  if(NOT ARG_FOLDER)
    set(ARG_FOLDER ${CMAKE_CURRENT_SOURCE_DIR}/${name})
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${ARG_FOLDER}/*.cpp)
  foreach(other ${ARG_WITHOUT})
    list(FILTER sources EXCLUDE REGEX "/${other}[.]cpp$")
  endforeach()
  add_library(prowl_${name} ${sources})
  add_library(prowl::${name} ALIAS prowl_${name})
  target_compile_features(prowl_${name} PUBLIC cxx_std_20)
  target_compile_options(prowl_${name} PRIVATE ${PROWL_STRICT_WARNINGS} $<$<BOOL:${ARG_LIGHT}>:${PROWL_LIGHT_OPTIONS}>)
  target_include_directories(prowl_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(prowl_${name} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE})
  if(ARG_FAST AND PROWL_SIMD STREQUAL "avx2")
    # Pinocchio's library was built without AVX: Eigen types that are passed to it keep the alignment that they have there.
    target_compile_options(prowl_${name} PRIVATE -mavx2 -mfma)
    target_compile_definitions(prowl_${name} PRIVATE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  set_target_properties(prowl_${name} PROPERTIES EXPORT_NAME ${name} DEFINE_SYMBOL "")
  if(ARG_INTERNAL)
    set_property(GLOBAL APPEND PROPERTY PROWL_INTERNAL_LAYERS prowl_${name})
  else()
    set_property(GLOBAL APPEND PROPERTY PROWL_LAYERS prowl_${name})
  endif()
endfunction()

# prowl_module(<name> <sources>): a library that is loaded when it is asked for (prowl/files/shared_library.hpp). Programs that name
# its classes link prowl::<name>.
function(prowl_module name)
  add_library(prowl_${name} SHARED ${ARGN})
  add_library(prowl::${name} ALIAS prowl_${name})
  target_compile_options(prowl_${name} PRIVATE ${PROWL_STRICT_WARNINGS})
  set_target_properties(prowl_${name} PROPERTIES EXPORT_NAME ${name} DEFINE_SYMBOL "")
endfunction()

# prowl_solver(<name>): a solver of others, prowl/solvers/foreign/<name>_solver.cpp, as a module.
function(prowl_solver name)
  prowl_module(${name} solvers/foreign/${name}_solver.cpp)
  target_link_libraries(prowl_${name} PUBLIC prowl::solvers PRIVATE prowl_dep_${name} fmt::fmt ${CMAKE_DL_LIBS})
  target_compile_definitions(prowl_${name} PRIVATE PROWL_FATROP_VERSION="${PROWL_FATROP_VERSION}")
  set_property(GLOBAL APPEND PROPERTY PROWL_LAYERS prowl_${name})
endfunction()
