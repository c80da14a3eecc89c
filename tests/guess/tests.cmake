prowl_test(guess/monotone_cubic prowl::guess)
prowl_test(guess/initial_guess prowl::guess)
