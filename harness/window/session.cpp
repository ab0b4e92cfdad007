#include "window/session.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "api/error.h"
#include "window/messages.h"

namespace lodbench::window {
namespace {

constexpr double kCallLimitS = 60;
constexpr std::chrono::milliseconds kTimeToEnd{2000};

std::span<const std::uint8_t> map_pictures(const base::FileDescriptor& file) {
    if (ftruncate(file.number(), off_t(kPictureBytes)) != 0) {
        throw EnvironmentError(fmt::format("no memory for pictures: {}", std::strerror(errno)));
    }
    void* const memory = mmap(nullptr, kPictureBytes, PROT_READ, MAP_SHARED, file.number(), 0);
    if (memory == MAP_FAILED) {
        throw EnvironmentError(
            fmt::format("the memory for pictures cannot be mapped: {}", std::strerror(errno)));
    }
    return {static_cast<const std::uint8_t*>(memory), kPictureBytes};
}

/// A descriptor's copy that exec leaves open, as text.
std::string inherited(int descriptor) {
    fcntl(descriptor, F_SETFD, 0);
    return fmt::format("{}", descriptor);
}

}  // namespace

Session::Session(std::filesystem::path program, std::function<void()> wake)
    : program_(std::move(program)),
      wake_(std::move(wake)),
      picture_file_(base::memory_file("pictures")),
      picture_(map_pictures(picture_file_)) {}

Session::~Session() {
    stop();
    munmap(const_cast<std::uint8_t*>(picture_.data()), picture_.size());
}

void Session::start() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
        throw EnvironmentError(
            fmt::format("cannot speak with a process: {}", std::strerror(errno)));
    }
    socket_ = base::FileDescriptor(ends[0]);
    const base::FileDescriptor theirs(ends[1]);
    const base::FileDescriptor signs_file = base::memory_file("signs");
    if (ftruncate(signs_file.number(), off_t(sysconf(_SC_PAGESIZE))) != 0) {
        throw EnvironmentError(fmt::format("no memory for signs: {}", std::strerror(errno)));
    }
    signs_ = run::map_signs(signs_file.number());
    hang_.emplace(signs_, kCallLimitS);
    child_ = std::make_unique<base::ChildProcess>([&] {
        std::string texts[] = {program_.string(), "--session", inherited(theirs.number()),
                               inherited(signs_file.number()), inherited(picture_file_.number())};
        std::vector<char*> argv;
        for (std::string& text : texts) argv.push_back(text.data());
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        return 127;
    });
    {
        const std::lock_guard lock(mutex_);
        answers_.clear();
        ended_ = false;
    }
    waiting_ = 0;
    answered_ = false;
    reader_ = std::thread([this] { read(); });
}

void Session::read() {
    for (;;) {
        std::optional<Json::Value> answer;
        try {
            answer = receive_message(socket_.number());
        } catch (const std::exception&) {  // nonsense: as if it had fallen
        }
        {
            const std::lock_guard lock(mutex_);
            if (answer) answers_.push_back(std::move(*answer));
            ended_ = !answer.has_value();
        }
        wake_();
        if (!answer) return;
    }
}

void Session::stop() {
    if (!child_) return;
    shutdown(socket_.number(), SHUT_RDWR);  // the reader sees the end, and the child
    if (reader_.joinable()) reader_.join();
    // It gives its objects back and goes by itself, unless it hangs.
    if (!child_->wait(kTimeToEnd)) child_->end();
    child_.reset();
    socket_ = {};
}

void Session::open(const run::CellSpec& spec) {
    if (!child_) start();
    asked_ = spec;
    failed_.clear();
    Json::Value message;
    message["do"] = "open";
    message["spec"] = run::write_spec(spec);
    if (timer_trusted_ && timer_device_ == spec.device) message["timer_trusted"] = *timer_trusted_;
    ask(message);
}

void Session::ask(const Json::Value& message) {
    if (!child_) return;
    if (send_message(socket_.number(), message)) ++waiting_;
}

void Session::note(const Json::Value& answer) {
    if (waiting_ > 0) --waiting_;
    answered_ = true;
    if (answer.isMember("failed")) failed_ = answer["failed"].asString();
    if (answer["did"] != "open") {
        if (!failed_.empty() || answer.isMember("refused")) return;
        // It drew: this is what one can go back to.
        if (answer["did"] == "picture" && asked_ && method_ == asked_->method) good_ = asked_;
        return;
    }
    if (answer.isMember("timer_trusted") && asked_) {
        timer_trusted_ = answer["timer_trusted"].asBool();
        timer_device_ = asked_->device;
    }
    method_ = answer.isMember("method") ? answer["method"].asString() : std::string();
}

std::vector<Json::Value> Session::take() {
    std::deque<Json::Value> answers;
    bool ended = false;
    {
        const std::lock_guard lock(mutex_);
        answers.swap(answers_);
        ended = ended_;
    }
    for (const Json::Value& answer : answers) note(answer);
    if (child_ && !ended && waiting_ > 0) {
        if (const run::Call call = hang_->hung_in(); call != run::Call::none) {
            asked_to_end_ =
                fmt::format("did not come back from {} for {} s", run::name_of(call), kCallLimitS);
            child_->end();
        }
    }
    if (child_ && ended) replace();
    return {answers.begin(), answers.end()};
}

void Session::replace() {
    const run::Call call = signs_->call.load();
    if (!child_->wait(kTimeToEnd)) child_->end();
    const std::string name = asked_ ? asked_->method : "no method";
    const std::string plugin = asked_ ? asked_->plugin.filename().string() : "";
    std::string why = failed_;
    if (why.empty()) why = asked_to_end_;
    if (why.empty()) {
        why = child_->ending().words();
        if (call != run::Call::none) why += fmt::format(", in {}", run::name_of(call));
    }
    fallen_ = fmt::format("'{}' of {} fell: {}", name, plugin, why);
    asked_to_end_.clear();
    failed_.clear();
    method_.clear();
    stop();
    if (!answered_) {  // nor would the next: it waits until it is asked for
        waiting_ = 0;
        asked_.reset();
        good_.reset();
        return;
    }
    start();
    const bool another = good_ && asked_ && run::write_spec(*good_) != run::write_spec(*asked_);
    if (!another) {
        asked_.reset();
        good_.reset();
        return;
    }
    open(*good_);
}

std::string Session::fallen() {
    return std::exchange(fallen_, {});
}

void Session::end() {
    if (!child_) return;
    asked_to_end_ = "was ended on request";
    child_->end();
}

std::span<const std::uint8_t> Session::picture(int width, int height) const {
    const std::size_t bytes = 3 * std::size_t(width) * std::size_t(height);
    if (width < 0 || height < 0 || bytes > picture_.size()) {
        throw ContractError(fmt::format("a picture of {} x {}", width, height));
    }
    return picture_.first(bytes);
}

}  // namespace lodbench::window
