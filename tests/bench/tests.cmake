# The judge of the benchmarks, the task files that it reads, and the random tasks. Where the peers are installed, their shooting
# problem too; elsewhere pytest skips those tests and says so. PROWL_WITH_PEERS=1 scripts/setup installs them, and scripts/bench.
set(bench_python ${PROWL_PYTHON})
if(EXISTS ${PROJECT_SOURCE_DIR}/.venv-peers/requirements.stamp)
  set(bench_python ${PROJECT_SOURCE_DIR}/.venv-peers/bin/python)
endif()
foreach(name checker load motion_task)
  add_test(NAME bench/${name}
    COMMAND ${bench_python} -m pytest -q -rs -p no:cacheprovider ${PROJECT_SOURCE_DIR}/bench/tests/${name}_test.py)
  set_tests_properties(bench/${name} PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_SOURCE_DIR}/bench;PYTHONDONTWRITEBYTECODE=1;OMP_NUM_THREADS=1;OPENBLAS_NUM_THREADS=1")
endforeach()
set_tests_properties(bench/load PROPERTIES COST 30)
