# A build by scripts/wheel (pyproject.toml), whose options are few: what it needs besides a build by hand.
if(NOT PROWL_WHEEL)
  message(FATAL_ERROR "Run scripts/wheel: it puts the shared libraries inside the wheel, which pip alone does not. Then pip install "
    "the file that it names.")
endif()
find_program(PROWL_CCACHE ccache)
if(PROWL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PROWL_CCACHE})
endif()

# Hidden when linked, not when compiled: the objects are those of a build by hand, which the compiler cache has.
add_link_options(LINKER:--version-script=${CMAKE_CURRENT_SOURCE_DIR}/cmake/wheel_symbols.map)

# A source file that includes Pinocchio takes up to 2.2 GB to compile: not more of them at once than there is memory for.
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT memory QUERY AVAILABLE_PHYSICAL_MEMORY)
math(EXPR jobs "${memory} / 2200")
if(jobs GREATER cores)
  set(jobs ${cores})
elseif(jobs LESS 1)
  set(jobs 1)
endif()
set_property(GLOBAL PROPERTY JOB_POOLS compile=${jobs})
set(CMAKE_JOB_POOL_COMPILE compile)
