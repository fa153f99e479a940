// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

int main(int argc, char** argv) { return mercury::run_program({argv + 1, argv + argc}); }
