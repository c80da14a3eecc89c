# The documentation: its pages as text, the site built from them and looked at in a browser, and every command in the pages.
# scripts/test installs what they need.
find_program(PROWL_DOXYGEN doxygen)
if(PROWL_BUILD_CLI AND PROWL_DOXYGEN AND EXISTS ${PROWL_VENV}/bin/mkdocs AND EXISTS ${PROJECT_SOURCE_DIR}/site/node_modules)
  foreach(name pages site commands)
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
