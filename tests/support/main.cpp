// The entry point of every test executable.
#include "support/until_end.hpp"

#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

int main(int count, char** arguments)
{
    const int failed = doctest::Context(count, arguments).run();
    tests::UntilEnd::get().destroy();
    return failed;
}
