// What is seen: the pictures, and Dear ImGui's panels over them.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "picture/color_map.h"
#include "results/cell_groups.h"
#include "run/knob.h"
#include "view/viewer.h"

namespace lodbench::view {

namespace {

using window::Layout;
using window::Style;

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255), kYellow = IM_COL32(255, 220, 0, 255),
                kBudget = IM_COL32(255, 90, 90, 255);

/// Wraps at the panel's edge.
void text(const std::string& words) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(words.c_str());
    ImGui::PopTextWrapPos();
}

/// Of the panel at the bottom: a line of widgets and one of text.
float path_height() {
    return ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeight() +
           2 * ImGui::GetStyle().WindowPadding.y;
}

/// The colours of the heat map, from none to the scale's top.
void color_bar() {
    constexpr int kSteps = 32;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = 6 * ImGui::GetTextLineHeight(), height = ImGui::GetFrameHeight();
    for (int i = 0; i < kSteps; ++i) {
        const picture::Rgb color = picture::error_color((i + 0.5) / kSteps);
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x + width * float(i) / kSteps, at.y},
            {at.x + width * float(i + 1) / kSteps, at.y + height},
            IM_COL32(color.r, color.g, color.b, 255));
    }
    ImGui::Dummy({width, height});
}

std::string figure(const std::optional<double>& value, const char* unit) {
    return value ? fmt::format("{:.4g} {}", *value, unit) : std::string("-");
}

template <typename Count>
std::string count(const std::optional<Count>& value) {
    return value ? fmt::format("{}", *value) : std::string("-");
}

ImTextureID texture_id(unsigned name) {
    return reinterpret_cast<ImTextureID>(std::uintptr_t(name));
}

/// The value that a parameter has: what is set, or its default.
std::string value_of(const run::ParamInfo& param, const run::Settings& settings) {
    for (const auto& [name, value] : settings) {
        if (name == param.name) return value;
    }
    if (param.type == ParamType::choice) return param.default_choice;
    if (param.type == ParamType::boolean) return param.default_number != 0 ? "true" : "false";
    return fmt::format("{}", param.default_number);
}

}  // namespace

void Viewer::note_item(const char* name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    Json::Value box = Json::arrayValue;
    for (const float edge : {low.x, low.y, high.x, high.y}) box.append(int(edge));
    items_[name] = box;
}

void Viewer::draw() {
    items_ = Json::objectValue;
    draw_pictures();
    if (frozen_ || top_) draw_frustum();
    draw_controls();
    draw_path();
    if (help_) draw_help();
}

void Viewer::draw_pictures() {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    for (const window::Pane& pane :
         window::panes(layout_, double(size.x), split_, second_blinks())) {
        const Side& side = sides_[std::size_t(pane.method)];
        const bool apart = layout_ == Layout::difference;
        const unsigned texture = apart ? difference_ : side.texture;
        const ImVec2 from(float(pane.x), 0), to(float(pane.x + pane.width), size.y);
        if (texture != 0) {
            list.AddImage(texture_id(texture), from, to, {float(pane.from), 0},
                          {float(pane.to), 1});
        }
        const std::string name =
            apart ? method(sides_[0]).id + " - " + method(sides_[1]).id + ", 8 times as bright"
                  : method(side).id;
        const float line = ImGui::GetTextLineHeightWithSpacing();
        list.AddText({from.x + line, size.y - path_height() - line}, kWhite, name.c_str());
        if (!side.words.empty()) {
            list.AddText(nullptr, 0, {from.x + line, size.y / 2}, kBudget, side.words.c_str(),
                         nullptr, std::max(to.x - from.x - 2 * line, line));
        }
    }
    if (layout_ == Layout::split) {
        const auto x = float(double(size.x) * split_);
        list.AddLine({x, 0}, {x, size.y}, kWhite, 2);
    }
}

/// Over the picture, not in it: what is behind a hill is seen too.
void Viewer::draw_frustum() {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Camera view = seen_from();
    const glm::dvec2 scale(double(size.x) / view.viewport.width,
                           double(size.y) / view.viewport.height);
    for (const auto& [from, to] : window::frustum_lines(selected(), sight())) {
        constexpr int kParts = 32;  // what passes the near plane is cut there, about
        for (int i = 0; i < kParts; ++i) {
            const auto a = view.project(glm::mix(from, to, double(i) / kParts));
            const auto b = view.project(glm::mix(from, to, double(i + 1) / kParts));
            if (!a || !b) continue;
            list.AddLine({float(a->x * scale.x), float(a->y * scale.y)},
                         {float(b->x * scale.x), float(b->y * scale.y)}, kYellow, 2);
        }
    }
}

void Viewer::draw_controls() {
    if (!overlay_) return;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    for (int i = 0; i < sides(); ++i) {
        Side& side = sides_[std::size_t(i)];
        const float width = std::min(20 * line, 0.45F * ImGui::GetIO().DisplaySize.x);
        const float x = i == 0 ? line / 2 : ImGui::GetIO().DisplaySize.x - width - line / 2;
        ImGui::SetNextWindowPos({x, line / 2}, ImGuiCond_Always);
        ImGui::SetNextWindowSize({width, 0});
        ImGui::SetNextWindowBgAlpha(0.85F);
        ImGui::Begin(i == 0 ? "first" : "second", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                         ImGuiWindowFlags_NoFocusOnAppearing);
        ImGui::PushItemWidth(0.5F * width);
        if (ImGui::BeginCombo("method", method(side).id.c_str())) {
            for (std::size_t m = 0; m < setup_.methods.size(); ++m) {
                if (ImGui::Selectable(setup_.methods[m].id.c_str(), m == side.method)) {
                    choose(side, m);
                }
                note_item(("choose " + setup_.methods[m].id).c_str());
            }
            ImGui::EndCombo();
        }
        note_item(i == 0 ? "method 1" : "method 2");
        draw_params(side);
        draw_graph(side);
        draw_figures(side);
        ImGui::PopItemWidth();
        ImGui::End();
    }
}

/// A slider for each number, the quality knob first; what is changed flies once it is let go.
void Viewer::draw_params(Side& side) {
    const run::MethodInfo& info = method(side);
    std::vector<const run::ParamInfo*> params;
    for (const run::ParamInfo& param : info.params) params.push_back(&param);
    std::ranges::stable_partition(
        params, [&](const run::ParamInfo* param) { return param->name == info.quality_knob; });
    const auto set = [&](const std::string& name, const std::string& value) {
        std::erase_if(side.settings, [&](const auto& setting) { return setting.first == name; });
        side.settings.emplace_back(name, value);
    };
    for (const run::ParamInfo* param : params) {
        const std::string value = value_of(*param, side.settings);
        const char* const name = param->name.c_str();
        const bool wide = param->minimum > 0 && param->maximum >= 10 * param->minimum;
        const ImGuiSliderFlags flags =
            ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
        bool changed = false;
        if (param->type == ParamType::boolean) {
            bool on = value == "true";
            changed = ImGui::Checkbox(name, &on);
            if (changed) set(param->name, on ? "true" : "false");
        } else if (param->type == ParamType::choice) {
            if (ImGui::BeginCombo(name, value.c_str())) {
                for (const std::string& choice : param->choices) {
                    if (!ImGui::Selectable(choice.c_str(), choice == value)) continue;
                    set(param->name, choice);
                    changed = true;
                }
                ImGui::EndCombo();
            }
        } else if (param->type == ParamType::integer) {
            int number = int(std::stod(value));
            if (ImGui::SliderInt(name, &number, int(param->minimum), int(param->maximum), "%d",
                                 flags)) {
                set(param->name, fmt::format("{}", number));
            }
            changed = ImGui::IsItemDeactivatedAfterEdit();
        } else {
            auto number = float(std::stod(value));
            if (ImGui::SliderFloat(name, &number, float(param->minimum), float(param->maximum),
                                   "%.4g", flags)) {
                const double within = std::clamp(double(number), param->minimum, param->maximum);
                set(param->name, fmt::format("{:.4g}", within));
            }
            changed = ImGui::IsItemDeactivatedAfterEdit();
        }
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", param->help.c_str());
        note_item((std::string(&side == sides_.data() ? "1 " : "2 ") + param->name).c_str());
        if (changed) open(side);
    }
}

void Viewer::draw_graph(const Side& side) {
    const std::vector<float>& ms = side.times.ms();
    if (ms.empty()) return;
    const double budget = setup_.scenario.measure.budget_ms;
    const float top = std::max(*std::ranges::max_element(ms), float(budget) * 1.25F);
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 3 * line);
    ImGui::PlotLines("##times", ms.data(), int(ms.size()), 0, nullptr, 0, top, size);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float y = high.y - (high.y - low.y) * float(budget) / top;
    ImGui::GetWindowDrawList()->AddLine({low.x, y}, {high.x, y}, kBudget);
    text(fmt::format("frame ms: median {:.3g}, P90 {:.3g}, P99 {:.3g}; budget {:.4g}",
                     side.times.percentile(0.5).value_or(0), side.times.percentile(0.9).value_or(0),
                     side.times.percentile(0.99).value_or(0), budget));
}

void Viewer::draw_figures(const Side& side) {
    if (side.opening) text("opening");
    if (side.reply) {
        const window::PictureReply& r = *side.reply;
        text(fmt::format("frame {:.3g} ms: select {:.3g}, submit {:.3g}, GPU {}", r.wall_ms,
                         r.select_ms, r.submit_ms, figure(r.gpu_ms, "ms")));
        text(fmt::format("triangles {}   draw calls {}", r.triangles, r.draw_calls));
        text(fmt::format("uploaded {} bytes   on the GPU {:.4g} MiB", r.uploaded_bytes,
                         double(r.gpu_bytes) / results::kMebibyte));
        if (r.crack_pixels) {
            text(fmt::format("pixel error P99.9 {}, max {}", figure(r.pixel_p999_px, "px"),
                             figure(r.pixel_max_px, "px")));
            text(fmt::format("crack pixels {}", count(r.crack_pixels)));
        }
    }
    if (side.measuring) text("measuring");
    if (side.measured) {
        const results::FrameRecord& m = *side.measured;
        ImGui::Separator();
        text(side.measured_flown ? fmt::format("measured: frame {}, as a run does", m.frame)
                                 : std::string("measured: this view"));
        text(fmt::format("triangles {}, of them with an area {}", count(m.triangles),
                         count(m.triangles_nondegenerate)));
        text(fmt::format("screen error P99.9 {}, max {}", figure(m.screen_p999_px, "px"),
                         figure(m.screen_max_px, "px")));
        text(fmt::format("pixel error P99.9 {}, max {}", figure(m.pixel_p999_px, "px"),
                         figure(m.pixel_max_px, "px")));
        text(fmt::format("crack pixels {}   uncovered samples {}", count(m.crack_pixels),
                         count(m.uncovered_samples)));
        text(fmt::format("height RMSE {}   PSNR {}", figure(m.height_rmse_m, "m"),
                         figure(m.psnr_db, "dB")));
    }
    if (side.probe && side.probe->hit) {
        const window::ProbeReply& p = *side.probe;
        ImGui::Separator();
        text(fmt::format("sample row {} column {}   level {}", p.row, p.column, count(p.level)));
        text(fmt::format("true {:.2f} to {:.2f} m   drawn {}", p.true_low, p.true_high,
                         p.drawn ? fmt::format("{:.2f} m", *p.drawn) : "nothing"));
        text(fmt::format("error {}, {}", figure(p.error_px, "px"), figure(p.error_m, "m")));
    }
}

void Viewer::draw_path() {
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0, size.y - path_height()});
    ImGui::SetNextWindowSize({size.x, path_height()});
    ImGui::SetNextWindowBgAlpha(0.85F);
    ImGui::Begin("path", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    int frame = playback_.frame();
    ImGui::SetNextItemWidth(size.x / 3);
    if (ImGui::SliderInt("frame", &frame, 0, playback_.frames() - 1)) {
        if (recorder_.recording()) toggle_recording();
        flying_ = false;
        playback_.play(false);
        playback_.seek(frame);
    }
    note_item("frame");
    ImGui::SameLine();
    std::string words = flying_ ? fmt::format("flying {:.4g} m/s", fly_.speed())
                                : (playback_.playing() ? "playing" : "paused");
    if (fly_.follows_ground()) words += ", following the ground";
    if (recorder_.recording()) words += fmt::format(", recording {}", recorder_.frames());
    words += fmt::format("   {}   {}", window::name_of(layout_), window::name_of(style_));
    if (frozen_) words += culling_frozen_ ? "   frozen" : "   selection frozen, culling not";
    if (top_) words += "   from above";
    ImGui::TextUnformatted((words + "   F1: keys").c_str());
    if (style_ == Style::errors) {
        auto scale = float(scale_px_);
        ImGui::SameLine();
        color_bar();
        ImGui::SameLine();
        ImGui::SetNextItemWidth(8 * line);
        if (ImGui::SliderFloat("px", &scale, 0.1F, 20, "to %.2g", ImGuiSliderFlags_Logarithmic)) {
            scale_px_ = double(scale);
        }
        note_item("scale");
    }
    ImGui::TextUnformatted(message_.c_str());
    ImGui::End();
}

void Viewer::draw_help() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::Begin("keys", nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    for (const window::KeyBinding& binding : window::key_bindings()) {
        text(fmt::format("{:>7}  {}", binding.name, binding.does));
    }
    text(fmt::format("{:>7}  {}", "right", "mouse button: what lies below the cursor"));
    ImGui::End();
}

}  // namespace lodbench::view
