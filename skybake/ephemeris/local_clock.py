"""Clocks of regions: their names, and which times and dates they show."""

from __future__ import annotations

from datetime import UTC, date, datetime, time, timedelta, tzinfo
from difflib import get_close_matches
from zoneinfo import ZoneInfo, available_timezones

from skybake.errors import ArgumentError, InputError

_MOST_SUGGESTED = 3


def find_zone(name: str) -> ZoneInfo:
    """Return the clock of a region such as ``Europe/Paris``.

    Raises
    ------
    InputError
        If the time zone database has no such region; the message names similar ones.
    """
    try:
        return ZoneInfo(name)
    # KeyError for an unknown name, the others for an invalid one.
    except (KeyError, ValueError, OSError) as error:
        known = available_timezones()
        if not known:
            raise InputError("no time zone database is installed (pip install tzdata)") from error
        like = _similar(name, known)
        hint = f"nearest: {', '.join(like)}" if like else "must be such as Europe/Paris or UTC"
        raise InputError(f"unknown time zone {name!r}; {hint}") from error


def _similar(name: str, known: set[str]) -> list[str]:
    """Return regions whose city, or whose whole name, is like a name in any case."""
    wanted = "_".join(name.casefold().split())
    names: dict[str, list[str]] = {}
    # Europe/Paris before posix/Europe/Paris.
    for one in sorted(known, key=lambda one: (one.count("/"), one)):
        for text in (one.casefold(), one.casefold().rpartition("/")[2]):
            if one not in names.setdefault(text, []):
                names[text].append(one)
    like = [wanted] if wanted in names else get_close_matches(wanted, names, _MOST_SUGGESTED, 0.75)
    return list(dict.fromkeys(one for text in like for one in names[text]))[:_MOST_SUGGESTED]


def utc_text(moment: datetime) -> str:
    """Write a time as ISO 8601 in UTC, as ``2026-06-21T04:00:00Z``."""
    return local_text(moment.astimezone(UTC)).replace("+00:00", "Z")


def local_text(moment: datetime) -> str:
    """Write a time as ISO 8601 by its own clock, with milliseconds if it has any."""
    return moment.isoformat(timespec="milliseconds" if moment.microsecond else "seconds")


def day_exists(day: date, zone: tzinfo) -> bool:
    """Whether a clock shows a date; where the date line moved, one was left out."""
    noon = datetime.combine(day, time(12), zone)
    return noon.astimezone(UTC).astimezone(zone).date() == day


def check_day(day: date, zone: tzinfo) -> None:
    """Refuse a date that a clock never showed.

    Raises
    ------
    ArgumentError
        That names `day`.
    """
    if not day_exists(day, zone):
        gap = _gap(datetime.combine(day, time(12)), zone)
        raise ArgumentError("{day}: {gap}, got {date}", gap=gap, date=day)


def from_local(moment: datetime, zone: tzinfo) -> datetime:
    """Return the one time, in UTC, at which a local clock shows a naive time.

    Raises
    ------
    InputError
        If it never shows it, or twice.
    """
    # Of a time that is shown twice these are both; of one that is never shown they are
    # what the clocks before and after the change would make of it.
    first, second = (moment.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
    if first.utcoffset() == second.utcoffset():
        return first.astimezone(UTC)
    if first.astimezone(UTC).astimezone(zone).replace(tzinfo=None) == moment:
        raise InputError(
            f"is ambiguous in {zone}, write {local_text(first)} or {local_text(second)}, "
            f"got {moment.isoformat()!r}"
        )
    raise InputError(f"{_gap(moment, zone)}, got {moment.isoformat()!r}")


def _gap(moment: datetime, zone: tzinfo) -> str:
    """Say that clocks never show a time, and what they do instead."""
    first, second = (moment.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
    change = _change(second.astimezone(UTC), first.astimezone(UTC), zone)
    before, after = (change + (one.utcoffset() or timedelta()) for one in (first, second))
    form = "%H:%M" if before.date() == after.date() else "%Y-%m-%d %H:%M"
    return f"does not exist in {zone}, where clocks change from {before:{form}} to {after:{form}}"


def _change(low: datetime, high: datetime, zone: tzinfo) -> datetime:
    """When between two times in UTC the clocks change."""
    before = low.astimezone(zone).utcoffset()
    while high - low > timedelta(seconds=1):
        middle = low + (high - low) / 2
        if middle.astimezone(zone).utcoffset() == before:
            low = middle
        else:
            high = middle
    return (high + timedelta(seconds=0.5)).replace(microsecond=0)
