# Formats for trainers against MuJoCo's own kinematics, and the environment of Gymnasium. PROWL_WITH_TRAINERS=1 scripts/setup
# installs what they need.
if(PROWL_BUILD_PYTHON AND EXISTS ${PROJECT_SOURCE_DIR}/.venv-trainers/requirements.stamp)
  add_test(NAME trainers/formats COMMAND ${PROJECT_SOURCE_DIR}/.venv-trainers/bin/python -m pytest -q -p no:cacheprovider
    ${CMAKE_CURRENT_LIST_DIR}/trainers_test.py)
  set_tests_properties(trainers/formats PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;OPENBLAS_NUM_THREADS=1;PROWL_COMMAND=$<TARGET_FILE:prowl_cli>")
endif()
