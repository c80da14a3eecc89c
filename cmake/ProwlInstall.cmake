# `cmake --install build --prefix DIR`: libraries, headers, robots and tasks, and a package for find_package(prowl). What runs is
# the component runtime: that and `python` are in a wheel.
# The libraries look for Pinocchio and Ipopt where they were found at build time: the virtual environment has to stay.
include(CMakePackageConfigHelpers)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/robots ${PROJECT_SOURCE_DIR}/tasks DESTINATION ${CMAKE_INSTALL_DATADIR}/prowl
  COMPONENT runtime FILES_MATCHING PATTERN *.toml)
install(FILES ${PROJECT_SOURCE_DIR}/docs/third-party.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

if(NOT BUILD_SHARED_LIBS)
  message(STATUS "Static build: no libraries to install, their users would need all of Prowl's own dependencies.")
  install(TARGETS prowl_ipopt prowl_fatrop prowl_uno prowl_formulations LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)
  return()
endif()

get_property(layers GLOBAL PROPERTY PROWL_LAYERS)
install(TARGETS ${layers} EXPORT prowlTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
get_property(internal_layers GLOBAL PROPERTY PROWL_INTERNAL_LAYERS)
install(TARGETS ${internal_layers} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)

set(internal_headers)
foreach(header ${PROWL_INTERNAL_HEADERS})
  list(APPEND internal_headers REGEX /${header}$ EXCLUDE)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/prowl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN *.hpp ${internal_headers})
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/prowl)
install(EXPORT prowlTargets NAMESPACE prowl:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/prowlConfig.cmake.in ${PROJECT_BINARY_DIR}/prowlConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/prowlConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/prowlConfig.cmake ${PROJECT_BINARY_DIR}/prowlConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)
