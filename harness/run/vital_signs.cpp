#include "run/vital_signs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <string_view>

namespace lodbench::run {

namespace {

template <std::size_t Size>
void put(std::array<char, Size>& place, const std::string& text) {
    place.fill(0);
    text.copy(place.data(), Size - 1);
}

/// "" where a character is none of letters, digits and `others`: the page is shared with a process
/// that may have scribbled over it.
template <std::size_t Size>
std::string take(const std::array<char, Size>& place, std::string_view others) {
    std::string text(place.data(), strnlen(place.data(), Size));
    const bool plain = std::ranges::all_of(text, [others](unsigned char c) {
        return std::isalnum(c) != 0 || others.find(char(c)) != std::string_view::npos;
    });
    return plain ? text : std::string();
}

}  // namespace

void GpuNote::write(const platform::GpuIdentity& gpu) {
    put(node_, gpu.node);
    put(vendor_, gpu.vendor);
    put(uuid_, gpu.uuid);
    software_ = gpu.software;
}

platform::GpuIdentity GpuNote::read() const {
    return {take(node_, ""), take(uuid_, "-"), take(vendor_, " .,()-/"), software_};
}

const char* name_of(Call call) {
    static constexpr std::array<const char*, std::size_t(Call::count_)> kNames = {
        "none",
        "start",
        "load_terrain",
        "open_plugin",
        "create",
        "prepare",
        "upload",
        "resize",
        "select",
        "draw",
        "settle",
        "pause_background",
        "resume_background",
        "counters",
        "release",
        "destroy",
        "write_results"};
    // The page is shared with a process that may have scribbled over it.
    return call < Call::count_ ? kNames[std::size_t(call)] : "an unknown call";
}

const char* name_of(Replay replay) {
    constexpr std::array kNames = {"no", "timing", "lockstep", "real-time", "whole-terrain"};
    return kNames.at(std::size_t(replay));
}

}  // namespace lodbench::run
