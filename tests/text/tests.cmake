prowl_test(text/name_check prowl::text)
prowl_test(text/nearest_name prowl::text)
prowl_test(text/shown_text prowl::text)
