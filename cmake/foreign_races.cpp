// SPDX-License-Identifier: Apache-2.0
// Part of every program that is built with the thread sanitizer, which knows nothing about libraries that are not.
//
// The distribution's oneTBB hands work over between its threads by means that the sanitizer does not see, so everything
// that runs inside a parallel loop looks like a race. Such reports are left out; that loops give the same bits for
// every number of threads is what tests/sim/reproducibility_test.cpp holds. Mesa draws with threads of its own.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() { return "race:tbb::detail\nrace:oneapi/tbb/\n"; }
extern "C" const char* __tsan_default_options();
extern "C" const char* __tsan_default_options() { return "ignore_noninstrumented_modules=1:print_suppressions=0"; }
