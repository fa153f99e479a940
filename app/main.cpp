#include "app/program.h"

int main(int argc, char** argv) { return mercury::run_program({argv + 1, argv + argc}); }
