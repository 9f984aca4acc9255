// Signals: blocked in all threads, awaited in one.
#include "voile/engine/app/signals.hpp"

#include "voile/engine/assets/cleanup.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <string_view>
#include <thread>
#include <utility>

namespace voile::engine
{

namespace
{

constexpr std::pair<int, const char*> k_ending[] = {
    {SIGHUP, "SIGHUP"}, {SIGINT, "SIGINT"}, {SIGQUIT, "SIGQUIT"}, {SIGTERM, "SIGTERM"}, {SIGXCPU, "SIGXCPU"}};

// nohup ignores signals, and so do shells for background jobs.
bool is_ignored(int signal)
{
    struct sigaction action = {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

std::string_view name_of(int signal)
{
    for (const auto& [number, name] : k_ending)
        if (number == signal)
            return name;
    return "a signal";
}

enum class Finish
{
    at_once,
    early, // an EarlyFinish exists
    requested
};
std::atomic<Finish> finish_mode{Finish::at_once};

void print_line(const std::string& text)
{
    // On a terminal the cursor may be behind typed or drawn text.
    const std::string line = (::isatty(STDERR_FILENO) == 1 ? "\n" : "") + text + "\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

void end_by(int signal)
{
    sigset_t received;
    sigemptyset(&received);
    sigaddset(&received, signal);
    pthread_sigmask(SIG_UNBLOCK, &received, nullptr);
    raise(signal);
}

void wait_and_end(const sigset_t& signals, const std::string& program)
{
    int signal = 0;
    while (sigwait(&signals, &signal) == 0)
    {
        Finish expected = Finish::early;
        if (signal == SIGINT && finish_mode.compare_exchange_strong(expected, Finish::requested))
        {
            print_line(program + ": interrupted; files are finished with the frames so far. Again: ends at once");
            continue;
        }
        run_cleanups();
        print_line(program + ": interrupted by " + std::string(name_of(signal)) + "; unfinished files are gone");
        end_by(signal);
    }
}

} // namespace

void end_cleanly_on_signals(const std::string& program)
{
    (void)::signal(SIGPIPE, SIG_IGN);
    (void)::signal(SIGXFSZ, SIG_IGN);
    sigset_t signals;
    sigemptyset(&signals);
    for (const auto& [signal, name] : k_ending)
        if (!is_ignored(signal))
            sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals, program] { wait_and_end(signals, program); }).detach();
}

EarlyFinish::EarlyFinish()
{
    finish_mode = Finish::early;
}

EarlyFinish::~EarlyFinish()
{
    finish_mode = Finish::at_once;
}

bool EarlyFinish::requested() const
{
    return finish_mode == Finish::requested;
}

void end_by_interrupt()
{
    (void)::signal(SIGINT, SIG_DFL);
    end_by(SIGINT);
    ::_exit(128 + SIGINT);
}

} // namespace voile::engine
