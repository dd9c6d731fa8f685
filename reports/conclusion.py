"""What a run comes to: its verdicts in the order in which they matter, their counts, one sentence."""

from __future__ import annotations

from collections.abc import Iterable

from oracles.verdict import Verdict, Word
from reports.results import Results

AGAINST: tuple[Word, ...] = ("fail", "invalid", "crash", "timeout", "error", "fixed")
"""Words that stand against a tracer by themselves."""

OPEN: tuple[Word, ...] = ("undecided", "unsupported", "known")
"""Words that stand neither for nor against it."""

ORDER: tuple[Word, ...] = (*AGAINST, "blocked", *OPEN, "pass")

_RANK = dict.fromkeys(AGAINST, 0) | {"blocked": 1} | dict.fromkeys(OPEN, 2) | {"pass": 3}


def ordered(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Those against the tracer first, then blocked, open, passed; each in the ladder's order."""
    return sorted(verdicts, key=lambda verdict: _RANK[verdict.verdict])


def counts(results: Results) -> list[tuple[Word, int]]:
    """Each word that occurs and how often, in the order of ORDER."""
    found = results.counts()
    return [(word, found[word]) for word in ORDER if word in found]


def sentence(results: Results) -> str:
    """The conclusion, to be read after the subject's name."""
    if not results.complete:
        done = f"{len(results.verdicts)} of {results.planned} checks"
        return f"was interrupted after {done}, partial results: {_findings(results)}"
    if results.conforms:
        return f"conforms: {_findings(results)}"
    return f"does not conform: {_findings(results)}"


def _findings(results: Results) -> str:
    total = len(results.verdicts)
    if not total:
        return "nothing was checked"
    found = results.counts()
    failing = sum(found.get(word, 0) for word in AGAINST if word != "fixed")
    parts = [
        _clause(failing, "fails", "fail"),
        _blocked(results, found.get("blocked", 0)),
        _clause(found.get("fixed", 0), "passes although listed as known", "pass although listed as known"),
    ]
    said = [part for part in parts if part] or _harmless(found)
    first, *rest = said
    amount, _, what = first.partition(" ")
    if what in ("passes", "pass") and int(amount) == total > 1:
        return f"all {total} checks pass"
    return ", ".join([f"{amount} of {total} {'check' if total == 1 else 'checks'} {what}", *rest])


def _harmless(found: dict[str, int]) -> list[str]:
    """Clauses of a run with nothing against the tracer."""
    parts = [
        f"{found.get('pass', 0)} {'passes' if found.get('pass') == 1 else 'pass'}",
        _clause(found.get("known", 0), "fails as known", "fail as known"),
        _clause(found.get("undecided", 0), "is undecided", "are undecided"),
        _clause(found.get("unsupported", 0), "is unsupported", "are unsupported"),
    ]
    return [part for part in parts if part]


def _blocked(results: Results, blocked: int) -> str:
    """Blocked "by them" only where each blocker is among those that fail, or blocked by one itself."""
    failing = {v.check for v in results.verdicts if v.verdict in (*AGAINST, "blocked")}
    theirs = any(v.verdict in AGAINST for v in results.verdicts) and all(
        v.blocked_by in failing for v in results.verdicts if v.verdict == "blocked"
    )
    by = " by them" if theirs else ""
    return _clause(blocked, f"is blocked{by}", f"are blocked{by}")


def _clause(n: int, one: str, many: str) -> str:
    return f"{n} {one if n == 1 else many}" if n else ""
