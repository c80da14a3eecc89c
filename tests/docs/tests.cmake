# The documentation: its pages as text, the site built from them and looked at in a browser, and every command in the pages.
# scripts/test installs what they need.

# docs/reference.md, which scripts/reference writes.
add_executable(file_keys ${PROJECT_SOURCE_DIR}/site/reference/file_keys.cpp)
set_target_properties(file_keys PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
target_link_libraries(file_keys PRIVATE prowl::batch prowl::online nlohmann_json::nlohmann_json)
if(PROWL_BUILD_CLI)
  add_test(NAME docs/reference
    COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/reference_test.py $<TARGET_FILE:prowl_cli> $<TARGET_FILE:file_keys>)
  set_tests_properties(docs/reference PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
endif()

find_program(PROWL_DOXYGEN doxygen)
if(PROWL_BUILD_CLI AND PROWL_DOXYGEN AND EXISTS ${PROWL_VENV}/bin/mkdocs AND EXISTS ${PROJECT_SOURCE_DIR}/site/node_modules)
  foreach(name notation pages site commands)
    add_test(NAME docs/${name} COMMAND ${PROWL_VENV}/bin/python ${CMAKE_CURRENT_LIST_DIR}/${name}_test.py $<TARGET_FILE:prowl_cli>
      ${PROWL_CMEEL}/share)
    set_tests_properties(docs/${name} PROPERTIES TIMEOUT 1200 ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
  set_tests_properties(docs/commands PROPERTIES PROCESSORS 2)
elseif(PROWL_BUILD_CLI)
  message(STATUS "Prowl: without the tests of the documentation")
endif()

add_test(NAME docs/words COMMAND ${PROWL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/words_test.py)
set_tests_properties(docs/words PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
if(PROWL_BUILD_CLI AND EXISTS ${PROJECT_SOURCE_DIR}/report/node_modules/@playwright)
  add_test(NAME docs/pictures COMMAND ${PROWL_VENV}/bin/python ${CMAKE_CURRENT_LIST_DIR}/pictures_test.py $<TARGET_FILE:prowl_cli>
    ${PROWL_CMEEL}/share)
  set_tests_properties(docs/pictures PROPERTIES TIMEOUT 300 ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
endif()
