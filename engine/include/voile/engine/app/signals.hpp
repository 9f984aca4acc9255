// Signals: a program that is asked to end leaves nothing unfinished behind.
#pragma once

#include <string>

namespace voile::engine
{

// From here on SIGHUP, SIGINT, SIGQUIT, SIGTERM and SIGXCPU, unless they are ignored, run the cleanups (cleanup.hpp)
// and end the program by the signal, after one line on standard error. A thread of its own waits for them, so that they
// work whatever the others do. SIGPIPE and SIGXFSZ are ignored: writing fails with an error instead. Call it once,
// before other threads are started. Programs that are started must get an empty signal mask and the default actions.
void end_cleanly_on_signals(const std::string& program);

} // namespace voile::engine
