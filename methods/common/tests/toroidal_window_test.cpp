// A window is drawn on a texture of sample coordinates: what it says that it holds must be there.

#include "common/toroidal_window.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace lodbench::common {
namespace {

/// Texels that remember which sample was written, within a larger texture that nothing else may
/// touch.
class Texture {
public:
    Texture(glm::ivec2 size) : size_(size), texels_(std::size_t(size.x * size.y), kNever) {}
    void write(const WindowPiece& piece) {
        const glm::ivec2 size = piece.samples.size();
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                at(piece.texel + glm::ivec2(x, y)) = piece.samples.low + glm::ivec2(x, y);
                ++written_;
            }
        }
    }
    [[nodiscard]] glm::ivec2& at(glm::ivec2 texel) {
        EXPECT_TRUE(texel.x >= 0 && texel.y >= 0 && texel.x < size_.x && texel.y < size_.y);
        return texels_.at(std::size_t(texel.y * size_.x + texel.x));
    }
    [[nodiscard]] std::int64_t written() const { return written_; }
    friend bool operator==(const Texture& a, const Texture& b) { return a.texels_ == b.texels_; }
    static constexpr glm::ivec2 kNever{1 << 30, 1 << 30};

private:
    glm::ivec2 size_;
    std::vector<glm::ivec2> texels_;
    std::int64_t written_ = 0;
};

constexpr glm::ivec2 kCorner{3, 5};

Texture texture_for(int samples) {
    return {kCorner + samples + 2};
}

/// The same place, written from nothing.
Texture entire_update(int samples, glm::ivec2 origin) {
    ToroidalWindow window(samples, kCorner);
    Texture texture = texture_for(samples);
    window.move_to(origin);
    window.advance(ToroidalWindow::kAllLines,
                   [&](const WindowPiece& piece) { texture.write(piece); });
    return texture;
}

void expect_held_samples_are_there(const ToroidalWindow& window, Texture& texture) {
    const LevelRect& held = window.held();
    for (int y = held.low.y; y < held.high.y; ++y) {
        for (int x = held.low.x; x < held.high.x; ++x) {
            ASSERT_EQ(texture.at(window.texel({x, y})), glm::ivec2(x, y));
        }
    }
}

struct Walk {
    const char* name;
    int longest_step;
    int teleports_of_100;
};
constexpr Walk kWalks[] = {
    {"slow", 1, 0}, {"fast", 9, 0}, {"faster than a window", 40, 0}, {"with teleports", 3, 10}};

class ToroidalWindowWalk : public ::testing::TestWithParam<std::tuple<int, Walk>> {
protected:
    glm::ivec2 step(glm::ivec2 place) {
        const auto pick = [this](int low, int high) {
            return std::uniform_int_distribution<int>(low, high)(random_);
        };
        const Walk& walk = std::get<1>(GetParam());
        if (pick(0, 99) < walk.teleports_of_100) return {pick(-5000, 5000), pick(-5000, 5000)};
        // Drifts to and fro across 0, where negative coordinates begin.
        const int drift = place.x > 60 ? -1 : place.x < -60 ? 1 : 0;
        return place + glm::ivec2(pick(-walk.longest_step, walk.longest_step) + drift,
                                  pick(-walk.longest_step, walk.longest_step) + drift);
    }
    std::mt19937 random_{7};
};

TEST_P(ToroidalWindowWalk, equals_the_entire_update_and_writes_only_what_came_in) {
    const int samples = std::get<0>(GetParam());
    ToroidalWindow window(samples, kCorner);
    Texture texture = texture_for(samples);
    glm::ivec2 place(0);
    for (int i = 0; i < 1000; ++i) {
        place = step(place);
        window.move_to(place);
        const std::int64_t incoming = window.target().area() - window.held().area();
        const std::int64_t before = texture.written();
        int strips = 0;
        while (const auto strip = window.next_strip()) {
            for (const WindowPiece& piece : window.pieces(*strip)) texture.write(piece);
            window.fill(*strip);
            ++strips;
        }
        ASSERT_TRUE(window.complete());
        ASSERT_EQ(window.held(), (LevelRect{place, place + samples}));
        ASSERT_EQ(texture.written() - before, incoming);
        ASSERT_LE(strips, 2) << "a move of a complete window is an L";
        ASSERT_TRUE(texture == entire_update(samples, place)) << "step " << i;
    }
}

TEST_P(ToroidalWindowWalk, within_a_budget_holds_what_it_says_and_completes_when_it_rests) {
    const int samples = std::get<0>(GetParam());
    for (const int budget : {1, 3}) {
        ToroidalWindow window(samples, kCorner);
        Texture texture = texture_for(samples);
        glm::ivec2 place(0);
        for (int i = 0; i < 1000; ++i) {
            // Rests now and then for long enough to fill all from nothing.
            const bool resting = i % 100 > 50;
            if (!resting) place = step(place);
            window.move_to(place);
            const int lines =
                window.advance(budget, [&](const WindowPiece& piece) { texture.write(piece); });
            ASSERT_LE(lines, budget);
            ASSERT_EQ(lines == budget || window.complete(), true) << "the budget is used";
            expect_held_samples_are_there(window, texture);
            ASSERT_TRUE(window.target().contains(window.held()));
            if (i % 100 == 99) {
                ASSERT_TRUE(window.complete());
                ASSERT_TRUE(texture == entire_update(samples, place)) << "step " << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, ToroidalWindowWalk,
                         ::testing::Combine(::testing::Values(1, 2, 15, 16),
                                            ::testing::ValuesIn(kWalks)),
                         [](const auto& combination) {
                             std::string name = std::to_string(std::get<0>(combination.param)) +
                                                "_" + std::get<1>(combination.param).name;
                             std::ranges::replace(name, ' ', '_');
                             return name;
                         });

TEST(ToroidalWindow, a_diagonal_move_is_an_l_of_columns_and_then_rows) {
    ToroidalWindow window(8);
    window.advance(ToroidalWindow::kAllLines, [](const WindowPiece&) {});
    window.move_to({2, -3});
    EXPECT_EQ(window.held(), (LevelRect{{2, 0}, {8, 5}}));
    EXPECT_EQ(window.next_strip(), (LevelRect{{8, 0}, {10, 5}}));
    EXPECT_EQ(window.next_strip(1), (LevelRect{{8, 0}, {9, 5}}));
    window.fill({{8, 0}, {10, 5}});
    EXPECT_EQ(window.next_strip(), (LevelRect{{2, -3}, {10, 0}}));
    EXPECT_EQ(window.next_strip(2), (LevelRect{{2, -2}, {10, 0}})) << "next to what is held";
    window.fill({{2, -3}, {10, 0}});
    EXPECT_TRUE(window.complete());
    EXPECT_FALSE(window.next_strip());
}

TEST(ToroidalWindow, pieces_end_where_the_window_wraps_around) {
    const ToroidalWindow window(8, {100, 200});
    const auto whole = window.pieces({{-3, 5}, {5, 13}});
    ASSERT_EQ(whole.size(), 4U);
    EXPECT_EQ(whole[0].samples, (LevelRect{{-3, 5}, {0, 8}}));
    EXPECT_EQ(whole[0].texel, glm::ivec2(105, 205));
    EXPECT_EQ(whole[1].samples, (LevelRect{{0, 5}, {5, 8}}));
    EXPECT_EQ(whole[1].texel, glm::ivec2(100, 205));
    EXPECT_EQ(whole[3].samples, (LevelRect{{0, 8}, {5, 13}}));
    EXPECT_EQ(whole[3].texel, glm::ivec2(100, 200));
    EXPECT_EQ(window.pieces({{0, 0}, {8, 8}}).size(), 1U);
    EXPECT_TRUE(window.pieces({}).empty());
}

TEST(ToroidalWindow, what_was_forgotten_or_left_is_not_held) {
    ToroidalWindow window(8);
    window.advance(ToroidalWindow::kAllLines, [](const WindowPiece&) {});
    EXPECT_TRUE(window.holds({{1, 1}, {7, 8}}));
    EXPECT_FALSE(window.holds({{1, 1}, {9, 8}}));
    window.move_to({4, 0});
    window.move_to({0, 0});
    EXPECT_EQ(window.held(), (LevelRect{{4, 0}, {8, 8}})) << "dropped by the first move";
    EXPECT_FALSE(window.complete());
    window.forget();
    EXPECT_TRUE(window.held().empty());
    window.move_to({800, 0});
    EXPECT_EQ(window.next_strip(3), (LevelRect{{800, 0}, {808, 3}}));
}

TEST(ToroidalWindow, refuses_what_would_make_its_word_wrong) {
    EXPECT_THROW(ToroidalWindow(0), ContractError);
    ToroidalWindow window(8);
    EXPECT_THROW(window.pieces({{0, 0}, {9, 1}}), ContractError);
    EXPECT_THROW(window.fill({{0, 1}, {8, 2}}), ContractError) << "not at the north";
    EXPECT_THROW(window.fill({{0, 0}, {7, 2}}), ContractError) << "not of full width";
    EXPECT_THROW(window.fill({}), ContractError);
    window.fill({{0, 0}, {8, 8}});
    EXPECT_THROW(window.fill({{0, 0}, {8, 8}}), ContractError) << "complete";
}

}  // namespace
}  // namespace lodbench::common
