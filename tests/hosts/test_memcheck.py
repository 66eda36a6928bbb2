# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""valgrind finds no error of the plugin in meshlabserver."""

import memcheck
import pytest

pytestmark = pytest.mark.full

REPORT = """<valgrindoutput><error><kind>UninitCondition</kind><what>Conditional jump</what><stack>
<frame><obj>/usr/lib/libc.so.6</obj><fn>memcpy</fn></frame><frame><obj>/there/{inner}</obj><fn>run</fn></frame>
</stack></error></valgrindoutput>"""


@pytest.mark.parametrize("inner, expected", [(memcheck.PLUGIN, 1), ("libQt5Core.so.5", 0)])
def test_an_error_with_the_plugin_on_its_stack_is_the_plugins(tmp_path, inner, expected):
    (tmp_path / "report.xml").write_text(REPORT.format(inner=inner))
    ours, all_errors = memcheck.judge(tmp_path / "report.xml")
    assert (len(ours), all_errors) == (expected, 1)


@pytest.mark.parametrize("parameters", memcheck.VARIANTS)
def test_no_error_and_no_leak(build, parameters):
    line, errors = memcheck.check(build, parameters)
    assert not errors, "\n".join([line, *errors])
