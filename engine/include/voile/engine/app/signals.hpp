// Signals: a signal that ends the program leaves no unfinished files, and Ctrl-C may let it finish early.
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

// While one exists, the first SIGINT does not end the program: it is reported on standard error and asks the program to
// finish early. The second ends it like any other signal. There may be one at a time.
class EarlyFinish
{
public:
    EarlyFinish();
    ~EarlyFinish();
    EarlyFinish(const EarlyFinish&) = delete;
    EarlyFinish& operator=(const EarlyFinish&) = delete;

    [[nodiscard]] bool requested() const;
};

// Ends the program by SIGINT, so that a shell sees that it was interrupted. Call this at the end of a program that has
// finished early.
[[noreturn]] void end_by_interrupt();

} // namespace voile::engine
