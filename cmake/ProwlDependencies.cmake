# Finds what the wheels of requirements.txt and the system packages ship. Nothing is downloaded here: scripts/setup does, or
# pip, which builds with a Python of its own.
if(SKBUILD)
  set(PROWL_PYTHON ${Python_EXECUTABLE})
else()
  set(PROWL_VENV ${CMAKE_CURRENT_SOURCE_DIR}/.venv CACHE PATH "Virtual environment with the pinned wheels")
  set(PROWL_PYTHON ${PROWL_VENV}/bin/python)
endif()
if(NOT EXISTS ${PROWL_PYTHON})
  message(FATAL_ERROR "No virtual environment at ${PROWL_VENV}: run scripts/setup, or set PROWL_VENV.")
endif()

# Where the wheels are: not always where Python's own packages are, for pip builds in a folder that it puts before them.
execute_process(COMMAND ${PROWL_PYTHON} -c
    "import importlib.util, pathlib; print(pathlib.Path(importlib.util.find_spec('mujoco').origin).parent.parent, end='')"
  OUTPUT_VARIABLE PROWL_SITE_PACKAGES COMMAND_ERROR_IS_FATAL ANY)
set(PROWL_CMEEL ${PROWL_SITE_PACKAGES}/cmeel.prefix)
set(PROWL_CASADI ${PROWL_SITE_PACKAGES}/casadi)

# Pinocchio brings its own Eigen and Boost; they must win over the system's.
list(PREPEND CMAKE_PREFIX_PATH ${PROWL_CMEEL})
set(Boost_NO_WARN_NEW_VERSIONS ON)  # newer than the CMake of Debian 12 knows
find_package(pinocchio 4.1 REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(Threads REQUIRED)

# Ipopt comes without a CMake package in the casadi wheel.
if(EXISTS ${PROWL_CASADI}/include/coin-or/IpTNLP.hpp)
  file(STRINGS ${PROWL_CASADI}/include/coin-or/IpoptConfig.h ipopt_version REGEX "define IPOPT_VERSION ")
  string(REGEX REPLACE ".*\"(.*)\".*" "\\1" ipopt_version "${ipopt_version}")
  if(ipopt_version VERSION_LESS 3.14)
    message(FATAL_ERROR "Ipopt ${ipopt_version} is too old: Prowl needs 3.14 (max_wall_time, get_curr_iterate).")
  endif()
  add_library(prowl_dep_ipopt SHARED IMPORTED)
  set_target_properties(prowl_dep_ipopt PROPERTIES
    IMPORTED_LOCATION ${PROWL_CASADI}/libipopt.so
    INTERFACE_INCLUDE_DIRECTORIES ${PROWL_CASADI}/include/coin-or)
endif()

# Nor do Fatrop and BLASFEO; the CMake package of Fatrop in that wheel has the paths of its build machine.
if(NOT EXISTS ${PROWL_CASADI}/include/fatrop/fatrop.hpp OR NOT EXISTS ${PROWL_CASADI}/libfatrop.so)
  message(FATAL_ERROR "No Fatrop in ${PROWL_CASADI}: run scripts/setup.")
endif()
file(GLOB fatrop_library ${PROWL_CASADI}/libfatrop.so.*)  # its headers do not say the version
string(REGEX REPLACE ".*libfatrop[.]so[.]" "" PROWL_FATROP_VERSION "${fatrop_library}")
foreach(name fatrop blasfeo)
  add_library(prowl_dep_${name} SHARED IMPORTED)
  set_target_properties(prowl_dep_${name} PROPERTIES
    IMPORTED_LOCATION ${PROWL_CASADI}/lib${name}.so
    INTERFACE_INCLUDE_DIRECTORIES ${PROWL_CASADI}/include)
endforeach()
target_link_libraries(prowl_dep_fatrop INTERFACE prowl_dep_blasfeo)

# Uno comes with its header and no CMake package. To be linked after Ipopt: both libraries show a SPRAL, Uno's with OpenMP, and
# the first to be found serves both.
if(NOT EXISTS ${PROWL_CASADI}/include/uno/Uno_C_API.h OR NOT EXISTS ${PROWL_CASADI}/libuno.so)
  message(FATAL_ERROR "No Uno in ${PROWL_CASADI}: run scripts/setup.")
endif()
add_library(prowl_dep_uno SHARED IMPORTED)
set_target_properties(prowl_dep_uno PROPERTIES
  IMPORTED_LOCATION ${PROWL_CASADI}/libuno.so
  INTERFACE_INCLUDE_DIRECTORIES ${PROWL_CASADI}/include)

# MuJoCo comes without one too; the soname of its library carries the version.
set(PROWL_MUJOCO ${PROWL_SITE_PACKAGES}/mujoco)
file(GLOB mujoco_library ${PROWL_MUJOCO}/libmujoco.so.*)
if(NOT mujoco_library)
  message(FATAL_ERROR "No MuJoCo in ${PROWL_MUJOCO}: run scripts/setup.")
endif()
add_library(prowl_dep_mujoco SHARED IMPORTED)
set_target_properties(prowl_dep_mujoco PROPERTIES
  IMPORTED_LOCATION ${mujoco_library}
  INTERFACE_INCLUDE_DIRECTORIES ${PROWL_MUJOCO}/include)

find_package(tinyxml2 REQUIRED)
find_package(console_bridge REQUIRED)  # through which urdfdom speaks
find_package(urdfdom REQUIRED)
find_package(assimp 6.0 REQUIRED)
foreach(package fmt tomlplusplus nlohmann_json meshoptimizer)
  find_package(${package} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "No ${package}. On Debian and Ubuntu:\n  sudo apt-get install "
      "g++ python3-dev libcli11-dev libfmt-dev libtomlplusplus-dev nlohmann-json3-dev libmeshoptimizer-dev")
  endif()
endforeach()
