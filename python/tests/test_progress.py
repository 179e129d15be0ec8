# SPDX-License-Identifier: Apache-2.0
"""Progress of long work: functions that are told, and bars of tqdm."""
import shutil
import sys
import types

import pytest

import lfrendertools as lf


class Bar:
    """Stands for a bar of tqdm, and checks how it is used."""
    made = []

    def __init__(self, unit, total):
        self.unit, self.total, self.n, self.is_closed = unit, total, 0, False
        Bar.made.append(self)

    def update(self, step):
        assert not self.is_closed and step >= 0
        self.n += step

    def close(self):
        self.is_closed = True


@pytest.fixture()
def bars(monkeypatch):
    Bar.made = []
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    auto = types.ModuleType("tqdm.auto")
    auto.tqdm = Bar
    monkeypatch.setattr(sys.modules["tqdm"], "auto", auto, raising=False)
    monkeypatch.setitem(sys.modules, "tqdm.auto", auto)
    return Bar.made


def ended(bars):
    """Returns the final counts of the bars, all of which must be closed."""
    assert all(bar.is_closed for bar in bars)
    return [(bar.n, bar.total) for bar in bars]


def phases(told):
    """Returns the counts that were told, divided where they begin again."""
    parts = [[told[0]]]
    for before, now in zip(told, told[1:]):
        if now[0] < before[0] or before[0] == before[1]:
            parts.append([])
        parts[-1].append(now)
    return parts


def test_progress_is_told(field, path):
    told = []
    lf.render(field, path, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 0 and told == sorted(set(told))


@pytest.mark.parametrize("memory", ["8G", "31M"])
def test_progress_of_films_covers_all_passes(memory, field, path, bars):
    told = []
    assert len(list(lf.film(field, path, memory=memory, progress=lambda *now: told.append(now)))) == 3
    assert [done for done, _ in told] == sorted({done for done, _ in told}) and told[-1][0] == told[-1][1]
    list(lf.film(field, path, memory=memory, progress=True))
    assert ended(bars) == [told[-1]]


def test_two_phases_have_two_bars(field, path, bars, tmp_path):
    lf.compress(field, tmp_path / "a.lfs", verify=True, progress=True)
    assert ended(bars) == [(49, 49), (49, 49)]
    bars.clear()
    lf.synth("chart", tmp_path / "field", count=1, size=(48, 32), samples=1, truth=path, truth_samples=1, progress=True)
    assert ended(bars) == [(1, 1), (3, 3)]
    told = []
    lf.compress(field, tmp_path / "b.lfs", verify=True, progress=lambda *now: told.append(now))
    assert [part[-1] for part in phases(told)] == [(49, 49), (49, 49)]


def test_bars_close_after_errors(field, capture, path, bars, tmp_path):
    folder = shutil.copytree(capture, tmp_path / "field")
    broken = lf.open(folder)
    (folder / broken.names[-1]).unlink()
    with pytest.raises(lf.InputError):
        lf.compress(broken, tmp_path / "a.lfs", strict=True, progress=True)
    film = lf.film(field, path, memory="31M", progress=True)
    next(film)
    film.close()
    ended(bars)


def test_work_that_does_nothing_shows_no_bar(field, path, bars, tmp_path):
    lf.report(field, check="none", progress=True)
    lf.film(field, path, progress=True)
    assert not bars


@pytest.mark.parametrize("wrong", [3, "bar", [1]])
def test_progress_is_true_or_a_function(wrong, field, path, tmp_path):
    for action in (lambda: lf.render(field, path, progress=wrong), lambda: lf.film(field, path, progress=wrong),
                   lambda: lf.report(field, progress=wrong), lambda: lf.forecast(field, path, progress=wrong),
                   lambda: lf.compress(field, tmp_path / "a.lfs", progress=wrong),
                   lambda: lf.synth("chart", tmp_path / "field", progress=wrong)):
        with pytest.raises(TypeError, match="progress="):
            action()
    assert not list(tmp_path.iterdir())


def test_a_progress_bar_that_cannot_be_shown_is_told(field, path, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.warns(UserWarning, match="tqdm"):
        lf.render(field, path, progress=True)
