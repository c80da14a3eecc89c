prowl_test(model/so3 prowl::model)
prowl_test(model/configuration prowl::model)
prowl_test(model/urdf_check prowl::model)
