# Files and text take no time of a solve. GCC 12 compiles them in two thirds of the time with -O1.
set(PROWL_LIGHT_OPTIONS $<$<CONFIG:Release>:-O1>)

# prowl_layer(<name> [LIGHT] [INTERNAL] [FOLDER folder] [WITHOUT files of other targets] DEPENDS <layers and public libraries> PRIVATE <libraries that its headers do not show>)
# One library a folder, so that the linker too refuses an include against the direction of the layers. FOLDER: <name>, in the
# folder of the caller, if not said otherwise.
# INTERNAL: used by the command and the Python package only; its headers and target are not installed.
# LIGHT: no numerics; compiled with -O1.
function(prowl_layer name)
  cmake_parse_arguments(ARG "LIGHT;INTERNAL" "FOLDER" "DEPENDS;PRIVATE;WITHOUT" ${ARGN})
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
