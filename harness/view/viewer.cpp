#include "view/viewer.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "api/error.h"
#include "base/files.h"
#include "picture/png.h"
#include "results/json.h"
#include "run/knob.h"
#include "scenario/camera_string.h"

namespace lodbench::view {

namespace {

using window::Action;
using window::Layout;
using window::Style;

constexpr double kDegreesAcross = 90;  // that a drag over the whole window turns
constexpr double kLongestStep = 0.25;  // seconds: after a pause nothing leaps
constexpr double kRepeatS = 0.1;       // between pictures while background work goes on
constexpr int kRepeats = 20;           // of them
constexpr double kBlinkS = 0.5;
constexpr int kFramesToSettle = 3;      // that ImGui takes until what was touched is drawn
constexpr double kDividerReach = 0.01;  // of the window's width, to either side

Json::Value settings_json(const run::Settings& settings) {
    Json::Value json = Json::objectValue;
    for (const auto& [name, value] : settings) json[name] = value;
    return json;
}

void put(run::Settings& settings, const std::string& name, const std::string& value) {
    std::erase_if(settings, [&](const auto& setting) { return setting.first == name; });
    settings.emplace_back(name, value);
}

}  // namespace

Viewer::Viewer(Setup setup)
    : setup_(std::move(setup)),
      track_(setup_.scenario, *setup_.terrain),
      playback_(setup_.scenario.frames, setup_.scenario.rate_hz) {
    if (!setup_.log.empty()) log_.open(setup_.log);
    window_ = std::make_unique<Window>(
        setup_.window,
        WindowEvents{
            [this](int key_, bool control, bool pressed) { key(key_, control, pressed); },
            [this](int which, bool pressed, const glm::dvec2& at) { button(which, pressed, at); },
            [this](const glm::dvec2& at) { moved(at); },
            [this](double notches) { fly_.change_speed(notches); }});
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        Side& side = sides_[i];
        side.session = std::make_unique<window::Session>(setup_.program, Window::wake);
        const auto found = std::ranges::find(setup_.methods, setup_.shown[i], &run::MethodInfo::id);
        side.method = std::size_t(found - setup_.methods.begin());
        if (found == setup_.methods.end()) {  // the second, where none was named
            side.method = (sides_[0].method + 1) % setup_.methods.size();
        }
        side.settings = setup_.settings[side.method];
    }
    if (!setup_.shown[1].empty()) layout_ = Layout::split;
}

Viewer::~Viewer() {
    // First their readers, which wake the window.
    for (Side& side : sides_) {
        side.session.reset();
        glDeleteTextures(1, &side.texture);
    }
    glDeleteTextures(1, &difference_);
}

void Viewer::run() {
    double before = window_->seconds();
    while (!window_->closed()) {
        window_->wait(wait_seconds());
        const double now = window_->seconds();
        if (window_->take_touched()) redraw_ = kFramesToSettle;
        update(std::min(now - before, kLongestStep));
        before = now;
        if (layout_ == Layout::blink) redraw_ = std::max(redraw_, 1);
        if (redraw_ <= 0) continue;
        --redraw_;
        window_->begin_frame();
        draw();
        window_->end_frame([this] {
            if (std::exchange(screenshot_due_, false)) save_screenshot();
        });
        if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
            Json::Value event;
            event["event"] = "gl_error";
            event["number"] = error;
            log(event);
        }
        log_state();
    }
}

/// Endlessly where nothing moves: an idle window costs nothing.
double Viewer::wait_seconds() const {
    if (redraw_ > 0) return 0;
    const bool moves = playback_.playing() || recorder_.recording() || !held_.empty();
    if (moves) return 1.0 / 120;
    bool waiting = false, repeats = false;
    for (const Side& side : sides_) {
        waiting |= side.session->waiting() > 0;
        repeats |= side.asynchronous && side.repeats < kRepeats;
    }
    if (repeats || layout_ == Layout::blink) return kRepeatS;
    return waiting ? 0.5 : -1;  // a hang is looked for
}

void Viewer::update(double seconds) {
    fly(seconds);
    if (playback_.advance(seconds)) redraw_ = std::max(redraw_, 1);
    for (int i = 0; i < 2; ++i) {
        Side& side = sides_[std::size_t(i)];
        take_answers(side);
        if (i >= sides()) continue;
        if (side.session->method().empty() && !side.opening && side.words.empty()) open(side);
        ask_for_picture(side);
    }
    if (std::exchange(difference_due_, false)) show_difference();
}

/// In whole frames of the simulated rate, so that what is recorded is what was seen.
void Viewer::fly(double seconds) {
    window::FlyInput input = turn_;
    turn_ = {};
    const auto held = [&](Action one, Action other) {
        return int(held_.contains(one)) - int(held_.contains(other));
    };
    input.ahead = held(Action::ahead, Action::back);
    input.right = held(Action::right, Action::left);
    input.up = held(Action::up, Action::down);
    if (input.moves() && !flying_) take_over();
    unflown_ = flying_ && (input.moves() || recorder_.recording()) ? unflown_ + seconds : 0;
    const double frame_s = 1 / setup_.scenario.rate_hz;
    const auto ground = [this](const glm::dvec2& place) {
        return scenario::ground_height(*setup_.terrain, place);
    };
    if (input.turn_right != 0 || input.turn_up != 0) {
        window::FlyInput turn;
        turn.turn_right = std::exchange(input.turn_right, 0);
        turn.turn_up = std::exchange(input.turn_up, 0);
        fly_.step(turn, 0, ground);
    }
    for (; unflown_ >= frame_s; unflown_ -= frame_s) {
        fly_.step(input, frame_s, ground);
        recorder_.add(fly_.place());
    }
    if (input.moves() || recorder_.recording()) redraw_ = std::max(redraw_, 1);
}

void Viewer::take_over() {
    if (flying_) return;
    playback_.play(false);
    fly_.take_over(track_.camera(playback_.frame()));
    flying_ = true;
}

Camera Viewer::camera() const {
    Camera camera = flying_ ? fly_.camera() : track_.camera(playback_.frame());
    camera.viewport = window::picture_size(layout_, window_->pixels());
    return camera;
}

Camera Viewer::selected() const {
    return frozen_ ? frozen_camera_ : camera();
}

double Viewer::sight() const {
    const TerrainInfo& info = setup_.terrain->info();
    return glm::length(info.extent_max() - info.extent_min()) / 8;
}

/// A frozen selection keeps its size: its picture is fitted into the window.
Camera Viewer::seen_from() const {
    Camera view = top_ ? window::top_camera(selected(), sight()) : camera();
    view.viewport = selected().viewport;
    return view;
}

bool Viewer::second_blinks() const {
    return std::fmod(window_->seconds(), 2 * kBlinkS) >= kBlinkS;
}

run::Settings Viewer::effective(const Side& side) const {
    run::Settings settings = side.settings;
    if (frozen_ && !culling_frozen_) {
        const auto& params = method(side).params;
        const bool has = std::ranges::any_of(params, [](const run::ParamInfo& param) {
            return param.name == "culling" && param.type == ParamType::boolean;
        });
        if (has) put(settings, "culling", "false");
    }
    return settings;
}

void Viewer::open(Side& side) {
    run::CellSpec spec;
    spec.scenario_file = spec.scenario_origin = setup_.file;
    spec.overrides = setup_.overrides;
    spec.method = method(side).id;
    spec.plugin = method(side).plugin;
    spec.settings = effective(side);
    spec.device = setup_.device;
    side.opening = true;
    side.words.clear();
    side.asked.reset();
    side.measured.reset();
    side.probe.reset();
    side.times.clear();
    side.session->open(spec);
}

void Viewer::choose(Side& side, std::size_t method_index) {
    if (side.method != method_index) {
        side.method = method_index;
        side.settings = setup_.settings[method_index];
    }
    open(side);
}

void Viewer::turn_knob(Side& side, int way) {
    const auto knob = run::quality_knob(method(side));
    if (!knob) {
        tell(fmt::format("'{}' has no quality knob that is a number", method(side).id));
        return;
    }
    double value = knob->start;
    for (const auto& [name, text] : side.settings) {
        if (name == knob->name) value = std::stod(text);
    }
    constexpr double kFactor = 1.4142135623730951, kShare = 0.05;
    double turned = knob->geometric() ? value * std::pow(kFactor, way)
                                      : value + way * kShare * (knob->maximum - knob->minimum);
    if (knob->integer && std::round(turned) == value) turned = value + way;
    turned = knob->admitted(std::clamp(turned, knob->minimum, knob->maximum));
    put(side.settings, knob->name, knob->text(turned));
    open(side);
}

void Viewer::take_answers(Side& side) {
    for (const Json::Value& answer : side.session->take()) take_answer(side, answer);
    if (const std::string fell = side.session->fallen(); !fell.empty()) {
        side.opening = side.session->waiting() > 0;
        side.drawing = side.measuring = false;
        side.asked.reset();
        side.words = fell;
        tell(fell);
        Json::Value event;
        event["event"] = "fell";
        event["words"] = fell;
        log(event);
    }
}

void Viewer::take_answer(Side& side, const Json::Value& answer) {
    redraw_ = kFramesToSettle;
    const std::string did = answer["did"].asString();
    if (answer.isMember("refused")) tell(answer["refused"].asString());
    if (did == "open") {
        side.opening = false;
        side.drawing = false;
        if (answer.isMember("refused")) side.words = answer["refused"].asString();
        if (!answer.isMember("method")) return;
        side.asynchronous = answer["asynchronous"].asBool();
        const auto found =
            std::ranges::find(setup_.methods, answer["method"].asString(), &run::MethodInfo::id);
        if (found != setup_.methods.end()) {  // another one after a fall
            side.method = std::size_t(found - setup_.methods.begin());
        }
        Json::Value event = answer;
        event["event"] = "opened";
        event["side"] = Json::Int64(&side - sides_.data());
        event["process"] = side.session->process();
        event["settings"] = settings_json(side.settings);
        log(event);
    } else if (did == "picture") {
        side.drawing = false;
        if (!answer.isMember("failed") && !answer.isMember("refused")) take_picture(side, answer);
    } else if (did == "measure") {
        side.measuring = false;
        side.asked.reset();  // the picture below is another one
        if (!answer.isMember("record")) return;
        results::FrameRecord record;
        const std::string where = "answer";
        results::decode(answer["record"], record, {where, ""});
        side.measured = record;
        side.measured_flown = answer["flown"].asBool();
        Json::Value event = answer;
        event["event"] = "measured";
        event["method"] = method(side).id;
        log(event);
    } else if (did == "probe" && answer.isMember("hit")) {
        side.probe = window::probe_reply(answer);
        Json::Value event = answer;
        event["event"] = "probed";
        log(event);
    }
}

void Viewer::take_picture(Side& side, const Json::Value& answer) {
    side.reply = window::picture_reply(answer);
    const auto picture = side.session->picture(side.reply->width, side.reply->height);
    side.rgb.assign(picture.begin(), picture.end());
    upload(side.texture, side.texture_size, side.rgb, {side.reply->width, side.reply->height});
    side.times.add(side.reply->wall_ms);
    difference_due_ |= layout_ == Layout::difference;
    Json::Value event = answer;
    event["event"] = "picture";
    event["side"] = Json::Int64(&side - sides_.data());
    event["method"] = method(side).id;
    if (side.asked) event["request"] = to_json(*side.asked);
    log(event);
}

void Viewer::ask_for_picture(Side& side) {
    if (side.opening || side.drawing || side.measuring || side.session->method().empty()) return;
    window::PictureRequest request;
    request.selected = selected();
    request.view = seen_from();
    request.frame = flying_ ? 0 : playback_.frame();
    request.frozen = frozen_;
    request.wireframe = wireframe_;
    request.style = style_;
    request.scale_px = scale_px_;
    const double now = window_->seconds();
    if (side.asked && *side.asked == request) {
        const bool again = side.asynchronous && !frozen_ && side.repeats < kRepeats;
        if (!again || now < side.repeat_at) return;
        ++side.repeats;
    } else {
        side.repeats = 0;
        // They were of another view.
        if (side.asked && !(side.asked->view.position == request.view.position &&
                            side.asked->view.orientation == request.view.orientation)) {
            side.measured.reset();
            side.probe.reset();
        }
    }
    side.repeat_at = now + kRepeatS;
    side.asked = request;
    side.drawing = true;
    side.session->ask(to_json(request));
}

void Viewer::ask_to_measure(Side& side) {
    if (side.measuring || side.opening) return;
    Json::Value message;
    message["do"] = "measure";
    // Of the scenario's flight as a run flies there, of any other view as it is.
    message["flown"] = !flying_ && !frozen_;
    message["frame"] = flying_ ? 0 : playback_.frame();
    side.measuring = true;
    side.session->ask(message);
}

void Viewer::probe(const glm::dvec2& at) {
    const auto place = window::picture_place(layout_, split_, second_blinks(), at);
    Side& side = sides_[std::size_t(place.method)];
    if (side.opening || !side.asked) return;
    const Viewport& size = side.asked->view.viewport;
    Json::Value message;
    message["do"] = "probe";
    message["x"] = place.at.x * size.width;
    message["y"] = place.at.y * size.height;
    side.session->ask(message);
}

void Viewer::key(int number, bool control, bool pressed) {
    const auto action = window::action_of(number, control);
    if (!action) return;
    if (*action <= Action::down) {
        if (pressed) {
            held_.insert(*action);
        } else {
            held_.erase(*action);
        }
    } else if (pressed) {
        act(*action);
    }
}

void Viewer::act(Action action) {
    const auto ground = [this](const glm::dvec2& place) {
        return scenario::ground_height(*setup_.terrain, place);
    };
    const auto replay = [this] {
        if (recorder_.recording()) toggle_recording();
        flying_ = false;
    };
    switch (action) {
        case Action::follow:
            take_over();
            fly_.follow_ground(!fly_.follows_ground(), ground);
            break;
        case Action::play:
            replay();
            playback_.play(!playback_.playing());
            break;
        case Action::previous_frame:
        case Action::next_frame:
            replay();
            playback_.step(action == Action::next_frame ? 1 : -1);
            break;
        case Action::first_frame:
            replay();
            playback_.seek(0);
            break;
        case Action::record: toggle_recording(); break;
        case Action::copy_camera:
            window_->copy(scenario::camera_string(camera()));
            tell("copied " + scenario::camera_string(camera()));
            break;
        case Action::paste_camera: paste_camera(); break;
        case Action::wireframe: wireframe_ = !wireframe_; break;
        case Action::style: style_ = window::next(style_); break;
        case Action::layout:
            layout_ = window::next(layout_);
            difference_due_ = true;
            break;
        case Action::freeze:
        case Action::freeze_culling: {
            frozen_camera_ = selected();
            if (action == Action::freeze) frozen_ = !frozen_;
            if (action == Action::freeze_culling) culling_frozen_ = !culling_frozen_;
            if (culling_frozen_ && action == Action::freeze) break;
            for (int i = 0; i < sides(); ++i) open(sides_[std::size_t(i)]);
            break;
        }
        case Action::top_view: top_ = !top_; break;
        case Action::measure:
            for (int i = 0; i < sides(); ++i) ask_to_measure(sides_[std::size_t(i)]);
            break;
        case Action::screenshot: screenshot_due_ = true; break;
        case Action::overlay: overlay_ = !overlay_; break;
        case Action::help: help_ = !help_; break;
        case Action::quit: window_->close(); break;
        default: act_on_method(action); break;
    }
    redraw_ = kFramesToSettle;
}

/// Of the method below the cursor.
void Viewer::act_on_method(Action action) {
    const auto place = window::picture_place(layout_, split_, second_blinks(), cursor_);
    Side& side = sides_[std::size_t(place.method)];
    const std::size_t count = setup_.methods.size();
    if (action == Action::next_method) choose(side, (side.method + 1) % count);
    if (action == Action::previous_method) choose(side, (side.method + count - 1) % count);
    if (action == Action::finer) turn_knob(side, -1);
    if (action == Action::coarser) turn_knob(side, 1);
    if (action == Action::end_method) side.session->end();
}

void Viewer::button(int which, bool pressed, const glm::dvec2& at) {
    constexpr int kLeft = 0, kRight = 1;
    cursor_ = at;
    if (which == kLeft) {
        splitting_ = pressed && layout_ == Layout::split && std::abs(at.x - split_) < kDividerReach;
        turning_ = pressed && !splitting_;
    }
    if (which == kRight && pressed) probe(at);
}

void Viewer::moved(const glm::dvec2& at) {
    const glm::dvec2 by = at - cursor_;
    cursor_ = at;
    if (splitting_) split_ = std::clamp(at.x, 0.0, 1.0);
    if (turning_) {
        turn_.turn_right += by.x * kDegreesAcross;
        turn_.turn_up -= by.y * kDegreesAcross;
    }
}

void Viewer::toggle_recording() {
    if (!recorder_.recording()) {
        take_over();
        recorder_.start();
        recorder_.add(fly_.place());
        unflown_ = 0;
        tell("recording");
        return;
    }
    const std::filesystem::path file = new_file("path", "csv");
    base::write_whole(file, recorder_.stop());
    tell(fmt::format("{} frames recorded: lodbench run {} --flight {}", recorder_.frames(),
                     setup_.file.string(), file.string()));
    Json::Value event;
    event["event"] = "recorded";
    event["file"] = file.string();
    event["frames"] = Json::UInt64(recorder_.frames());
    event["camera"] = scenario::camera_string(camera());
    log(event);
}

void Viewer::paste_camera() {
    try {
        const Camera pasted = scenario::parse_camera(window_->pasted(), "the clipboard");
        take_over();
        fly_.take_over(pasted);
    } catch (const InputError& error) {
        tell(error.what());
    }
}

std::filesystem::path Viewer::new_file(const char* name, const char* extension) const {
    for (int number = 1;; ++number) {
        const auto file = setup_.out / fmt::format("lodbench-{}-{}.{}", name, number, extension);
        if (!std::filesystem::exists(file)) return file;
    }
}

void Viewer::save_screenshot() {
    const Viewport size = window_->pixels();
    const std::size_t stride = 3 * std::size_t(size.width);
    std::vector<std::uint8_t> upward(stride * std::size_t(size.height)), rows(upward.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
    for (std::size_t row = 0; row < std::size_t(size.height); ++row) {
        std::copy_n(&upward[(std::size_t(size.height) - 1 - row) * stride], stride,
                    &rows[row * stride]);
    }
    const std::filesystem::path file = new_file("view", "png");
    picture::write_png(file, size.width, size.height, rows);
    tell("screenshot " + file.string());
    Json::Value event;
    event["event"] = "screenshot";
    event["file"] = file.string();
    log(event);
}

void Viewer::show_difference() {
    if (sides_[0].rgb.empty() || sides_[0].rgb.size() != sides_[1].rgb.size()) return;
    const std::vector<std::uint8_t> rgb = window::difference(sides_[0].rgb, sides_[1].rgb);
    upload(difference_, difference_size_, rgb, sides_[0].texture_size);
}

/// A texture is made anew where the size changes, and at no other time.
void Viewer::upload(unsigned& texture, Viewport& size, const std::vector<std::uint8_t>& rgb,
                    const Viewport& of) {
    if (size != of) {
        glDeleteTextures(1, &texture);
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        glTextureStorage2D(texture, 1, GL_RGB8, of.width, of.height);
        glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        size = of;
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture, 0, 0, 0, of.width, of.height, GL_RGB, GL_UNSIGNED_BYTE,
                        rgb.data());
    redraw_ = std::max(redraw_, 1);
}

void Viewer::tell(const std::string& words) {
    message_ = words;
    Json::Value event;
    event["event"] = "message";
    event["words"] = words;
    log(event);
}

void Viewer::log(Json::Value event) {
    if (!log_.is_open()) return;
    event["seconds"] = window_->seconds();
    log_ << results::to_text(event) << std::endl;
}

/// Where it changed.
void Viewer::log_state() {
    if (!log_.is_open()) return;
    const Viewport size = window_->pixels();
    Json::Value state;
    state["event"] = "state";
    state["layout"] = window::name_of(layout_);
    state["style"] = window::name_of(style_);
    state["flying"] = flying_;
    state["follows"] = fly_.follows_ground();
    state["speed"] = fly_.speed();
    state["playing"] = playback_.playing();
    state["frame"] = playback_.frame();
    state["recording"] = recorder_.recording();
    state["frozen"] = frozen_;
    state["culling_frozen"] = culling_frozen_;
    state["top"] = top_;
    state["wireframe"] = wireframe_;
    state["overlay"] = overlay_;
    state["help"] = help_;
    state["split"] = split_;
    state["width"] = size.width;
    state["height"] = size.height;
    state["scale"] = window_->scale();
    state["camera"] = scenario::camera_string(camera());
    for (const Side& side : sides_) {
        state["methods"].append(method(side).id);
        state["settings"].append(settings_json(effective(side)));
        state["opening"].append(side.opening);
    }
    state["items"] = items_;
    if (state == logged_) return;
    logged_ = state;
    log(state);
}

}  // namespace lodbench::view
