# The documentation: its pages as text, the site built from them, and every command in them.
if(PROWL_BUILD_CLI)
  foreach(name pages site commands)
    add_test(NAME docs/${name} COMMAND ${PROWL_VENV}/bin/python ${CMAKE_CURRENT_LIST_DIR}/${name}_test.py $<TARGET_FILE:prowl_cli>
      ${PROWL_CMEEL}/share)
    set_tests_properties(docs/${name} PROPERTIES TIMEOUT 900 ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
endif()
