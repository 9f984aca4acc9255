// The program whose precompiled headers the tests use (voile_precompile).
// Its main function is that of doctest.
