prowl_test(diagnosis/elastic_solve prowl::diagnosis prowl::solvers)
prowl_test(diagnosis/change prowl::io prowl::diagnosis)
prowl_test(diagnosis/diagnosis prowl::io prowl::diagnosis prowl::solvers)
