#pragma once
// A method in a process of its own, as the window sees it: asked without waiting, replaced when it
// falls.

#include <json/value.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "base/child_process.h"
#include "run/cell.h"
#include "run/shared_signs.h"

namespace lodbench::window {

/// Owned by one thread, which asks and takes answers; `wake` is called from another one whenever
/// there may be something to take.
class Session {
public:
    /// `program` is run with --session and three descriptors, see serve_session.
    Session(std::filesystem::path program, std::function<void()> wake);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Opens a method in the place of the one before, in the process that is there or a new one.
    void open(const run::CellSpec& spec);
    /// Asks for anything else; nothing while no process runs.
    void ask(const Json::Value& message);
    /// Answers that came since, in order. A process that has ended is seen here: `fallen` says so,
    /// and a new one is started at once, with the method that last drew before the fallen one,
    /// unless that is the one which fell. Where it never answered, none is: neither would the next.
    [[nodiscard]] std::vector<Json::Value> take();
    /// Which method fell and why, since it was last asked; "" for none.
    [[nodiscard]] std::string fallen();
    /// Ends the process now: `fallen` says that it was asked for.
    void end();

    /// Questions that were not answered yet.
    [[nodiscard]] int waiting() const { return waiting_; }
    /// The method that was opened last and answered; "" while there is none.
    [[nodiscard]] const std::string& method() const { return method_; }
    /// What the last picture's answer describes; RGB, row 0 at the top. It is written by the next
    /// picture that is asked for.
    [[nodiscard]] std::span<const std::uint8_t> picture(int width, int height) const;
    /// 0 while none runs.
    [[nodiscard]] pid_t process() const { return child_ ? child_->pid() : 0; }

private:
    void start();
    void stop();
    void read();  ///< the reader's thread
    void replace();
    void note(const Json::Value& answer);

    std::filesystem::path program_;
    std::function<void()> wake_;
    std::shared_ptr<run::VitalSigns> signs_;
    base::FileDescriptor picture_file_;
    std::span<const std::uint8_t> picture_;
    base::FileDescriptor socket_;
    std::unique_ptr<base::ChildProcess> child_;
    std::thread reader_;
    std::mutex mutex_;
    std::deque<Json::Value> answers_;  // guarded
    bool ended_ = false;               // guarded: nothing comes any more
    std::optional<run::HangWatch> hang_;
    std::optional<run::CellSpec> asked_, good_;  // to be opened; the last that was
    std::string method_, failed_, fallen_, asked_to_end_;
    std::optional<bool> timer_trusted_;  // of timer_device_: it is tested once
    std::string timer_device_;
    int waiting_ = 0;
    bool answered_ = false;  // the process that runs now
};

}  // namespace lodbench::window
