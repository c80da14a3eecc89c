# The pages of `prowl report`, `prowl library` and `prowl mpc`, built from report/ by the Node.js of the wheels. scripts/setup fetches the packages that it takes;
# in a build by pip they are fetched here.
get_filename_component(python_folder ${PROWL_PYTHON} DIRECTORY)
find_program(PROWL_NODE node HINTS ${python_folder})
find_program(PROWL_NPM npm HINTS ${python_folder})
set(report ${PROJECT_SOURCE_DIR}/report)
if(SKBUILD AND PROWL_NODE AND PROWL_NPM AND NOT EXISTS ${report}/node_modules/.package-lock.json)
  get_filename_component(node_folder ${PROWL_NODE} DIRECTORY)
  execute_process(RESULT_VARIABLE npm_result COMMAND ${CMAKE_COMMAND} -E env "PATH=${node_folder}:$ENV{PATH}"
    ${PROWL_NPM} ci --prefix ${report} --no-audit --no-fund)
endif()

if(NOT PROWL_NODE OR NOT EXISTS ${report}/node_modules/.package-lock.json)
  message(WARNING "Prowl: no page for prowl report: Node.js or report/node_modules is missing; run scripts/setup.")
  return()
endif()
set(pages ${PROJECT_BINARY_DIR}/share/prowl)
set(page_files ${pages}/report.html ${pages}/library.html ${pages}/online.html)
file(GLOB sources CONFIGURE_DEPENDS ${report}/src/*)
add_custom_command(OUTPUT ${page_files}
  COMMAND ${PROWL_NODE} ${report}/build.mjs ${pages}
  DEPENDS ${sources} ${report}/build.mjs ${report}/package-lock.json
  COMMENT "Building the pages of report/" VERBATIM)
add_custom_target(report_page ALL DEPENDS ${page_files})
add_dependencies(prowl_cli report_page)
install(FILES ${page_files} DESTINATION ${CMAKE_INSTALL_DATADIR}/prowl COMPONENT runtime)
