#pragma once
// A plugin of many methods, each of which does nothing but misbehave in one call.

#include <cstddef>
#include <iterator>
#include <utility>

#include "quiet_method.h"

enum class When { create, select, draw, pause_background, counters, release, destroy };

struct Misbehaviour {
    const char* id;
    When when;
    void (*act)();  ///< in each such call
};

/// The method of entry `kEntry` of a table.
template <const auto& kTable, std::size_t kEntry>
class Misbehaving final : public QuietMethod {
public:
    explicit Misbehaving(const lodbench::Params& params) : QuietMethod(params) {
        act(When::create);
    }
    ~Misbehaving() override { act(When::destroy); }
    void select(const lodbench::Camera&, const lodbench::Clock&) override { act(When::select); }
    void draw(const lodbench::View&) override { act(When::draw); }
    void pause_background() override { act(When::pause_background); }
    [[nodiscard]] lodbench::Counters counters() const override {
        act(When::counters);
        return {};
    }
    void release(lodbench::gl::Device&) override { act(When::release); }

private:
    static void act(When now) {
        if (kTable[kEntry].when == now) kTable[kEntry].act();
    }
};

template <const auto& kTable, typename Entries>
struct MisbehavingMethods;
template <const auto& kTable, std::size_t... kEntries>
struct MisbehavingMethods<kTable, std::index_sequence<kEntries...>> {
    static constexpr lodbench::MethodDescriptor kAll[] = {
        quiet_descriptor<Misbehaving<kTable, kEntries>>(kTable[kEntries].id)...};
};

/// Exports the table's entries as the plugin's methods.
#define MISBEHAVING_PLUGIN(table_)                                                           \
    namespace {                                                                              \
    using Methods = MisbehavingMethods<table_, std::make_index_sequence<std::size(table_)>>; \
    }                                                                                        \
    LODBENCH_PLUGIN(Methods::kAll)
