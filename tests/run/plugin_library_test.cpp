// Listing plugins and checking settings: the words of each refusal.

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/plugin_library.h"
#include "support/raster_files.h"

namespace lodbench::run {
namespace {

using testing::HasSubstr;

std::filesystem::path broken(const std::string& name) {
    return std::filesystem::path(LODBENCH_BUILD_DIR) / "broken-plugins" / name / (name + ".so");
}

TEST(PluginLibrary, refusals_name_path_finding_and_expectation) {
    const std::pair<const char*, const char*> expected[] = {
        {"no_symbol", "it exports no symbol 'lodbench_plugin'"},
        {"wrong_abi", "its interface number is 99, expected 1"},
        {"wrong_tag", "its ABI tag is 'another compiler', expected '"},
        {"bad_descriptor",
         "parameter 'tau' of method 'bad-descriptor' has default 0, outside its range 0.25..16"},
        {"constructor_exits", "while it was loaded: the process exited with status 0"},
        {"constructor_aborts",
         "while it was loaded: aborted (signal 6) (its last words: 'out of luck')"},
        {"missing", "the loader says '"},
    };
    for (const auto& [name, words] : expected) {
        const PluginListing listing = list_plugin(broken(name));
        EXPECT_THAT(listing.refusal,
                    testing::StartsWith("plugin " + broken(name).string() + " cannot be used: "));
        EXPECT_THAT(listing.refusal, HasSubstr(words));
        EXPECT_TRUE(listing.methods.empty());
    }
}

TEST(PluginLibrary, a_constructor_that_loops_is_given_up_after_the_time_limit) {
    const PluginListing listing =
        list_plugin(broken("constructor_loops"), std::chrono::milliseconds(300));
    EXPECT_THAT(listing.refusal, HasSubstr("it did not load within 0.3 s"));
}

TEST(PluginLibrary, a_constructor_that_prints_does_not_disturb_the_listing) {
    const PluginListing listing = list_plugin(broken("constructor_prints"));
    EXPECT_EQ(listing.refusal, "");
    ASSERT_EQ(listing.methods.size(), 1U);
    EXPECT_EQ(listing.methods[0].id, "constructor-prints");
}

TEST(PluginLibrary, of_two_plugins_with_one_id_that_of_the_earlier_folder_is_used) {
    const auto listings =
        list_plugins({broken("duplicate").parent_path(), broken("healthy").parent_path()});
    ASSERT_EQ(listings.size(), 2U);
    ASSERT_EQ(listings[0].methods.size(), 1U);
    EXPECT_TRUE(listings[0].left_out.empty());
    EXPECT_TRUE(listings[1].methods.empty());
    EXPECT_EQ(listings[1].refusal, "");
    EXPECT_THAT(
        listings[1].left_out,
        testing::ElementsAre(fmt::format(
            "method 'healthy' is held by two plugins: {} is used, for its folder goes first; "
            "{} is not; remove one, or give its method another id",
            listings[0].path.string(), listings[1].path.string())));
    EXPECT_EQ(find_method(listings, "healthy", "here").plugin, listings[0].path);
}

/// A folder with copies of the plugin of the method `healthy` under these names.
class Copies {
public:
    Copies(std::initializer_list<const char*> names) {
        for (const char* name : names) {
            std::filesystem::copy_file(broken("healthy"), path(name));
        }
    }
    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return std::filesystem::canonical(folder_.path()) / (name + ".so");
    }
    [[nodiscard]] std::vector<PluginListing> listings() const {
        return list_plugins({folder_.path()});
    }

private:
    test::TemporaryFolder folder_;
};

TEST(PluginLibrary, of_two_unknown_plugins_with_one_id_in_one_folder_neither_is_used) {
    const Copies copies{"mine", "yours"};
    const auto listings = copies.listings();
    ASSERT_EQ(listings.size(), 2U);
    EXPECT_TRUE(listings[0].methods.empty() && listings[1].methods.empty());
    try {
        (void)find_method(listings, "healthy", "here");
        FAIL() << "a method was found";
    } catch (const InputError& error) {
        EXPECT_THAT(
            error.what(),
            HasSubstr(fmt::format("held by two plugins: neither {} nor {} is used, for "
                                  "nothing tells which is meant",
                                  copies.path("mine").string(), copies.path("yours").string())));
    }
}

TEST(PluginLibrary, nor_is_a_third_of_a_later_folder_for_it_was_not_meant_either) {
    const Copies copies{"mine", "yours"};
    const auto listings =
        list_plugins({copies.path("mine").parent_path(), broken("duplicate").parent_path()});
    ASSERT_EQ(listings.size(), 3U);
    for (const PluginListing& listing : listings) EXPECT_TRUE(listing.methods.empty());
    for (const std::size_t loser : {1U, 2U}) {
        ASSERT_EQ(listings[loser].left_out.size(), 1U);
        EXPECT_THAT(listings[loser].left_out[0],
                    HasSubstr(fmt::format("neither {} nor {} is used", copies.path("mine").string(),
                                          listings[loser].path.string())));
    }
}

TEST(PluginLibrary, a_newcomer_to_a_folder_does_not_take_the_place_of_lodbench_s_own) {
    // By their names, the first of which goes before the others in their order.
    const Copies copies{"a_newcomer", "lindstrom", "persistent_grid"};
    const auto listings = copies.listings();
    ASSERT_EQ(listings.size(), 3U);
    EXPECT_EQ(find_method(listings, "healthy", "here").plugin, copies.path("lindstrom"));
    for (const auto& [loser, name] : {std::pair(0, "a_newcomer"), {2, "persistent_grid"}}) {
        EXPECT_TRUE(listings[std::size_t(loser)].methods.empty());
        ASSERT_EQ(listings[std::size_t(loser)].left_out.size(), 1U);
        EXPECT_THAT(
            listings[std::size_t(loser)].left_out[0],
            HasSubstr(fmt::format("{} is used, for lodbench was built with it first; {} is not",
                                  copies.path("lindstrom").string(), copies.path(name).string())));
    }
}

TEST(PluginLibrary, what_one_plugin_loses_to_another_does_not_cost_its_other_methods) {
    const auto listings =
        list_plugins({broken("takes_an_id").parent_path(), broken("stand_ins").parent_path()});
    EXPECT_EQ(find_method(listings, "refined", "here").plugin, broken("takes_an_id"));
    EXPECT_EQ(find_method(listings, "every-sample", "here").plugin, broken("stand_ins"));
}

TEST(PluginLibrary, tells_how_the_compiler_was_called) {
    EXPECT_EQ(list_plugin(broken("healthy")).methods.at(0).compiled, LODBENCH_COMPILED);
    EXPECT_THAT(list_plugin(broken("compiled_otherwise")).methods.at(0).compiled,
                testing::StartsWith("not optimised"));
}

TEST(PluginLibrary, one_folder_named_twice_is_no_duplicate) {
    const auto folder = broken("healthy").parent_path();
    const auto listings = list_plugins({folder, folder / ".." / "healthy"});
    ASSERT_EQ(listings.size(), 1U);
    EXPECT_EQ(listings[0].refusal, "");
}

MethodInfo method_with_params() {
    MethodInfo method;
    method.id = "m";
    method.params = {{"tau", ParamType::real, 1, 0.25, 16, "", {}, ""},
                     {"count", ParamType::integer, 3, 1, 9, "", {}, ""},
                     {"cull", ParamType::boolean, 1, 0, 1, "", {}, ""},
                     {"cracks", ParamType::choice, 0, 0, 0, "none", {"none", "skirt"}, ""}};
    return method;
}

TEST(PluginLibrary, code_stays_mapped_for_threads_that_are_still_leaving_it) {
    const std::string path = LODBENCH_PLUGINS "/template_method.so";
    { const PluginLibrary library(path); }
    void* still = dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD);
    EXPECT_NE(still, nullptr);
    if (still != nullptr) dlclose(still);
}

TEST(MakeParams, fills_in_defaults_and_reads_every_type) {
    const Params defaults = make_params(method_with_params(), {}, "here");
    EXPECT_EQ(defaults.real("tau"), 1);
    EXPECT_EQ(defaults.integer("count"), 3);
    EXPECT_TRUE(defaults.boolean("cull"));
    EXPECT_EQ(defaults.choice("cracks"), "none");
    const Params set = make_params(
        method_with_params(),
        {{"tau", "0.5"}, {"count", "9"}, {"cull", "false"}, {"cracks", "skirt"}}, "here");
    EXPECT_EQ(set.real("tau"), 0.5);
    EXPECT_EQ(set.integer("count"), 9);
    EXPECT_FALSE(set.boolean("cull"));
    EXPECT_EQ(set.choice("cracks"), "skirt");
}

TEST(MakeParams, refusals_name_place_value_and_what_would_be_right) {
    const std::tuple<const char*, const char*, const char*> bad[] = {
        {"tau", "17",
         "here: '17' is no value for parameter 'tau' of method 'm'; give a number in 0.25..16"},
        {"tau", "nan", "'nan' is no value"},
        {"tau", "1px", "'1px' is no value"},
        {"tau", "", "'' is no value"},
        {"count", "2.5", "give an integer in 1..9"},
        {"cull", "1", "give true or false"},
        {"cracks", "glue", "give one of none, skirt"},
        {"tao", "1", "method 'm' has no parameter 'tao'; known: tau, count, cull, cracks"},
    };
    for (const auto& [name, value, words] : bad) {
        try {
            (void)make_params(method_with_params(), {{name, value}}, "here");
            FAIL() << name << "=" << value << " was accepted";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(words));
        }
    }
}

}  // namespace
}  // namespace lodbench::run
