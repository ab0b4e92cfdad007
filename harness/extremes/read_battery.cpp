#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"
#include "extremes/battery.h"
#include "scenario/overrides_section.h"
#include "scenario/toml_section.h"
#include "terrain/toml_file.h"

namespace lodbench::extremes {

namespace fs = std::filesystem;
using scenario::Section;

namespace {

constexpr const char* kKind = "a battery of extremes";

std::string required_text(Section& section, const char* key) {
    const auto text = section.text(key);
    if (!text) section.require(key, fmt::format("write {} = \"...\"", key));
    return *text;
}

std::vector<std::string> texts(Section& section, const char* key) {
    std::vector<std::string> list;
    const toml::node* node = section.node(key);
    if (node == nullptr) return list;
    const toml::array* array = node->as_array();
    if (array == nullptr) section.refuse(key, "write a list of texts");
    for (const toml::node& entry : *array) {
        if (!entry.is_string()) section.refuse(key, "write a list of texts");
        list.push_back(entry.as_string()->get());
    }
    return list;
}

fs::path file_beside(Section& section, const char* key, const fs::path& folder) {
    const std::string name = required_text(section, key);
    std::error_code none;
    if (!fs::is_regular_file(folder / name, none)) {
        section.refuse(key, fmt::format("no such file ({})", (folder / name).string()));
    }
    return folder / name;
}

WorldChange read_world(Section& section) {
    WorldChange world;
    if (const auto shift = section.numbers("shift", 2, 2, {-1e12, 1e12})) {
        world.shift = {(*shift)[0], (*shift)[1]};
    }
    world.scale = section.number("scale", {1e-12, 1e12}).value_or(1);
    if (const auto log2 = section.integer("scale_log2", -40, 40)) {
        if (section.has("scale")) section.refuse("scale_log2", "there is a scale too; write one");
        world.scale = std::ldexp(1.0, int(*log2));
    }
    return world;
}

Step read_step(Section& section) {
    Step step;
    step.name = required_text(section, "name");
    step.overrides = scenario::read_overrides(section, "override");
    step.world = read_world(section);
    step.knob = section.text("knob").value_or("");
    step.refused = section.boolean("refused").value_or(false);
    if (step.refused && step.knob.empty()) {
        section.require("knob", "write the value that is to be refused");
    }
    step.quick = section.boolean("quick").value_or(false);
    step.heavy = section.boolean("heavy").value_or(false);
    section.refuse_unknown(kKind);
    return step;
}

Axis read_axis(const fs::path& file) {
    const toml::table table = terrain::read_toml(file);
    Section top(table, file, "");
    Axis axis;
    axis.id = file.stem().string();
    axis.title = required_text(top, "title");
    axis.about = required_text(top, "about");
    axis.overrides = scenario::read_overrides(top, "override");
    for (Section& section : top.sections("step")) {
        Step step = read_step(section);
        if (std::ranges::find(axis.steps, step.name, &Step::name) != axis.steps.end()) {
            section.refuse("name", "a step before it has this name; write another");
        }
        axis.steps.push_back(std::move(step));
    }
    if (axis.steps.empty()) top.require("step", "write at least one table [[step]]");
    top.refuse_unknown(kKind);
    return axis;
}

/// Its axis and steps have to be there.
void require_known(const Inherent& inherent, const std::vector<Axis>& axes,
                   const Section& section) {
    if (inherent.axis.empty()) {
        if (!inherent.steps.empty()) section.refuse("steps", "of which axis? Write axis = \"...\"");
        return;
    }
    const auto axis = std::ranges::find(axes, inherent.axis, &Axis::id);
    if (axis == axes.end()) section.refuse("axis", "no axis of the battery has this name");
    for (const std::string& step : inherent.steps) {
        if (std::ranges::find(axis->steps, step, &Step::name) != axis->steps.end()) continue;
        section.refuse("steps", fmt::format("axis {} has no step \"{}\"", axis->id, step));
    }
}

std::vector<Inherent> read_inherent(const fs::path& file, const std::vector<Axis>& axes) {
    const toml::table table = terrain::read_toml(file);
    Section top(table, file, "");
    std::vector<Inherent> list;
    for (Section& section : top.sections("inherent")) {
        Inherent& inherent = list.emplace_back();
        inherent.method = required_text(section, "method");
        inherent.axis = section.text("axis").value_or("");
        inherent.steps = texts(section, "steps");
        inherent.what = texts(section, "what");
        inherent.why = required_text(section, "why");
        inherent.where = section.where();
        section.refuse_unknown(kKind);
        require_known(inherent, axes, section);
    }
    top.refuse_unknown(kKind);
    return list;
}

}  // namespace

bool WorldChange::is_power_of_two() const {
    int exponent = 0;
    return std::frexp(scale, &exponent) == 0.5;
}

bool Inherent::covers(const std::string& of_method, const std::string& of_axis,
                      const std::string& step, const std::string& fault) const {
    const auto names = [](const std::vector<std::string>& list, const std::string& name) {
        return list.empty() || std::ranges::find(list, name) != list.end();
    };
    return method == of_method && (axis.empty() || axis == of_axis) && names(steps, step) &&
           names(what, fault);
}

const Axis& Battery::axis(const std::string& id) const {
    const auto found = std::ranges::find(axes, id, &Axis::id);
    if (found != axes.end()) return *found;
    std::vector<std::string> names;
    for (const Axis& known : axes) names.push_back(known.id);
    throw InputError(
        fmt::format("extremes: there is no axis '{}'; known: {}", id, fmt::join(names, ", ")));
}

Battery read_battery(const fs::path& folder) {
    const fs::path file = folder / "battery.toml";
    const toml::table table = terrain::read_toml(file);
    Section top(table, file, "");
    Battery battery;
    battery.mild = file_beside(top, "mild", folder);
    battery.quick_mild = file_beside(top, "quick_mild", folder);
    for (const std::string& name : texts(top, "axes")) {
        const fs::path axis = folder / (name + ".toml");
        std::error_code none;
        if (!fs::is_regular_file(axis, none)) {
            top.refuse("axes", fmt::format("no such file ({})", axis.string()));
        }
        battery.axes.push_back(read_axis(axis));
    }
    if (battery.axes.empty()) top.require("axes", "write the names of the axes' files");
    battery.inherent = read_inherent(file_beside(top, "inherent", folder), battery.axes);
    top.refuse_unknown(kKind);
    return battery;
}

}  // namespace lodbench::extremes
