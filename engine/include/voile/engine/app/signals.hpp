// Signals: a signal that ends the program leaves no unfinished files.
#pragma once

#include <string>

namespace voile::engine
{

// Installs the handling of signals. From now on SIGHUP, SIGINT, SIGQUIT, SIGTERM and SIGXCPU, unless they are ignored,
// run the cleanups (cleanup.hpp) and end the program by the signal, after one line on standard error. A separate thread
// waits for them, so they work whatever the other threads do. SIGPIPE and SIGXFSZ are ignored: writing fails with an
// error instead. Call this once, before other threads are started. Child processes must be started with an empty signal
// mask and the default actions.
void end_cleanly_on_signals(const std::string& program);

} // namespace voile::engine
