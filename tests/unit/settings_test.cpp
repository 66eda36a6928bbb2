// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of parameters is complete and consistent, and values beyond either end of a range are refused.
#include "vcg_core/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "vcg_core/base/error.h"

namespace neuralmesh {
namespace {

using Kind = SettingInfo::Kind;

/// The message that check() throws, or nothing.
std::string complaint(const Settings& settings) {
    try {
        settings.check();
    } catch (const SettingError& error) {
        return error.what();
    }
    return {};
}

TEST(Settings, TheDefaultsPass) { EXPECT_NO_THROW(Settings().check()); }

TEST(Settings, EveryRowIsCompleteAndItsIdUnique) {
    std::set<std::string> ids;
    for (const SettingInfo& info : setting_table()) {
        SCOPED_TRACE(info.id);
        EXPECT_TRUE(ids.insert(info.id).second);
        for (const char c : std::string(info.id)) EXPECT_TRUE((c >= 'a' && c <= 'z') || c == '_');
        EXPECT_GT(std::string(info.label).size(), 3U);
        EXPECT_EQ(std::string(info.help).back(), '.');
        const int members = (info.boolean_member != nullptr ? 1 : 0) +
                            (info.integer_member != nullptr ? 1 : 0) + (info.real_member != nullptr ? 1 : 0);
        EXPECT_EQ(members, 1);
        EXPECT_LT(info.low, info.high);
        EXPECT_EQ(info.kind == Kind::choice, !info.choices.empty());
        EXPECT_EQ(info.kind == Kind::choice ? info.high + 1 : 0, static_cast<double>(info.choices.size()));
    }
}

TEST(Settings, StoreAndValueAreInverse) {
    for (const SettingInfo& info : setting_table()) {
        SCOPED_TRACE(info.id);
        for (const double value : {info.low, info.high}) {
            Settings settings;
            info.store(settings, value);
            EXPECT_EQ(info.value(settings), value);
            for (const SettingInfo& other : setting_table()) {
                if (&other == &info) continue;
                EXPECT_EQ(other.value(settings), other.value(Settings())) << other.id;
            }
        }
    }
}

TEST(Settings, BothEndsOfARangePassAndNothingBeyond) {
    for (const SettingInfo& info : setting_table()) {
        SCOPED_TRACE(info.id);
        if (info.kind == Kind::boolean) continue;
        const bool real = info.real_member != nullptr;
        for (const double end : {info.low, info.high}) {
            Settings settings;
            info.store(settings, end);
            EXPECT_EQ(complaint(settings), "");
            const double beyond = real ? std::nextafter(end, end == info.low ? -1e300 : 1e300)
                                       : end + (end == info.low ? -1 : 1);
            if (!real && std::abs(beyond) > std::numeric_limits<int>::max()) continue;
            info.store(settings, beyond);
            EXPECT_THROW(settings.check(), SettingError);
        }
        if (!real) continue;
        for (const double bad :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()}) {
            Settings settings;
            info.store(settings, bad);
            EXPECT_THROW(settings.check(), SettingError);
        }
    }
}

TEST(Settings, IntegersOutsideTheRangeOfIntAreRefused) {
    const double two_to_32 = 4294967296.0;
    for (const SettingInfo& info : setting_table()) {
        SCOPED_TRACE(info.id);
        if (info.integer_member == nullptr) continue;
        for (const double beyond : {info.low + two_to_32, info.high + two_to_32, -two_to_32, 1e300, -1e300,
                                    std::numeric_limits<double>::quiet_NaN()}) {
            Settings settings;
            info.store(settings, beyond);
            EXPECT_THROW(settings.check(), SettingError) << beyond;
        }
    }
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

}  // namespace
}  // namespace neuralmesh
