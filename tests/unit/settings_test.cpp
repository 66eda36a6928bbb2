// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The tables of parameters are complete and consistent, and values beyond either end of a range are refused.
#include "vcg_core/settings.h"

#include <cctype>

#include "tests/unit/support/prelude.h"

namespace neuralmesh::settings_test {

using Kind = SettingInfo::Kind;

/// The message that check() throws, or nothing.
std::string complaint(const Settings& settings, const std::vector<SettingInfo>& table = setting_table()) {
    return complaint_of([&] { settings.check(table); });
}

using TableOf = const std::vector<SettingInfo>& (*)();
class EveryTable : public testing::TestWithParam<TableOf> {
protected:
    const std::vector<SettingInfo>& table() const { return GetParam()(); }
};
INSTANTIATE_TEST_SUITE_P(Settings, EveryTable, testing::Values(setting_table, counter_table));

TEST_P(EveryTable, DefaultsPass) { EXPECT_EQ(complaint(Settings(), table()), ""); }

TEST_P(EveryTable, EveryRowIsCompleteAndItsIdUnique) {
    std::set<std::string> ids;
    for (const SettingInfo& info : table()) {
        SCOPED_TRACE(info.id);
        EXPECT_TRUE(ids.insert(info.id).second);
        for (const char c : std::string(info.id)) EXPECT_TRUE((c >= 'a' && c <= 'z') || c == '_');
        EXPECT_GT(std::string(info.label).size(), 3U);
        EXPECT_EQ(std::string(info.help).back(), '.');
        EXPECT_LT(info.low, info.high);
        EXPECT_EQ(info.kind == Kind::choice, !info.choices.empty());
        EXPECT_EQ(info.kind == Kind::choice ? info.high + 1 : 0, static_cast<double>(info.choices.size()));
    }
}

TEST_P(EveryTable, BeginsWithAtMostEightForANewcomer) {
    const auto first_advanced =
        std::find_if(table().begin(), table().end(), [](const SettingInfo& info) { return info.advanced; });
    EXPECT_LE(first_advanced - table().begin(), 8);
    EXPECT_TRUE(
        std::all_of(first_advanced, table().end(), [](const SettingInfo& info) { return info.advanced; }));
}

TEST_P(EveryTable, FollowsTheStagesOfARunInBothParts) {
    for (std::size_t i = 1; i < table().size(); ++i)
        if (table()[i].advanced == table()[i - 1].advanced) {
            EXPECT_LE(table()[i - 1].stage, table()[i].stage) << table()[i].id;
        }
}

/// Numbers that a later release may tune belong to the code. Those of the paper's equations have one digit.
TEST_P(EveryTable, HelpHasNoTunedNumbers) {
    for (const SettingInfo& info : table()) {
        const std::string help = info.help;
        EXPECT_EQ(help.find('%'), std::string::npos) << info.id;
        for (std::size_t i = 1; i < help.size(); ++i)
            EXPECT_FALSE(std::isdigit(static_cast<unsigned char>(help[i - 1])) != 0 &&
                         (std::isdigit(static_cast<unsigned char>(help[i])) != 0 || help[i] == ','))
                << info.id << ": " << help;
    }
}

TEST_P(EveryTable, StoreAndValueAreInverse) {
    for (const SettingInfo& info : table()) {
        SCOPED_TRACE(info.id);
        for (const double value : {info.low, info.high}) {
            Settings settings;
            info.store(settings, value);
            EXPECT_EQ(info.value(settings), value);
            for (const SettingInfo& other : table()) {
                if (&other == &info) continue;
                EXPECT_EQ(other.value(settings), other.value(Settings())) << other.id;
            }
        }
    }
}

TEST_P(EveryTable, BothEndsOfARangePassAndNothingBeyond) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity(), kTwoTo32 = 4294967296.0;
    for (const SettingInfo& info : table()) {
        SCOPED_TRACE(info.id);
        if (info.kind == Kind::boolean) continue;
        const bool real = std::holds_alternative<double Settings::*>(info.member);
        const auto complaint_of = [&](double value) {
            Settings settings;
            info.store(settings, value);
            return complaint(settings, table());
        };
        std::vector<double> bad = {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
        for (const double end : {info.low, info.high}) {
            EXPECT_EQ(complaint_of(end), "");
            const double outwards = end == info.low ? -1 : 1;
            bad.push_back(real ? std::nextafter(end, 1e300 * outwards) : end + outwards);
        }
        // Of integers, what is another one modulo 2^32 is none of the range.
        if (!real)
            bad.insert(bad.end(), {info.low + kTwoTo32, info.high + kTwoTo32, -kTwoTo32, 1e300, -1e300});
        for (const double value : bad) EXPECT_NE(complaint_of(value), "") << value;
    }
}

/// Scripts that know a parameter of one filter may rely on it in the other.
TEST(Settings, WhatBothFiltersHaveMeansTheSame) {
    std::size_t shared = 0;
    for (const SettingInfo& one : setting_table())
        for (const SettingInfo& other : counter_table()) {
            if (std::string(one.id) != other.id) continue;
            ++shared;
            EXPECT_STREQ(one.help, other.help);
            EXPECT_EQ(one.value(Settings()), other.value(Settings()));
        }
    EXPECT_EQ(shared, counter_table().size() - 2) << "all but signal_layer and signals_per_vertex";
}

TEST(Settings, TheMessageNamesParameterValueAndRange) {
    Settings settings;
    settings.signals_per_split = 0;
    EXPECT_EQ(complaint(settings),
              "The parameter signals_per_split (Signals per split) is 0: choose a value from 1 to 1000000.");
    settings = {};
    settings.random_seed = -7;
    EXPECT_NE(complaint(settings).find("random_seed"), std::string::npos);
    EXPECT_NE(complaint(settings).find("-7"), std::string::npos);
    EXPECT_NE(complaint(settings).find("2147483647"), std::string::npos);
}

}  // namespace neuralmesh::settings_test
