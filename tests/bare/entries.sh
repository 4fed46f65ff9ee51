# shellcheck shell=bash
# Which public functions of core have a wrapper, and which have none. Sourced by check.sh.

# Without one, and why.
exceptions() {
    sed 's/ *#.*//; /^$/d' <<'LIST'
MassSpring::empty     # needs a growable owner of memory: a host's
Snapshot::empty       # the same
Growable::particles   # that owner's own
Growable::springs     # that owner's own
Preconditions::takes  # cannot be named outside; the steps by solvers in lanes call it
LIST
}

functions() { find ../../core/src -name '*.rs' -print0 | sort -z | xargs -0 awk -f functions.awk | sort -u; }

# What the wrappers in a list of symbols are there for.
wrapped() { sed -nE 's/^.* T f(32|64)::([A-Za-z0-9_]+::[A-Za-z0-9_]+).*$/\2/p' <<<"$1" | sort -u; }

# Fails with the functions that no wrapper in the list of symbols calls, and the exceptions that are none.
forgotten() {
    local missing stale
    missing=$(comm -23 <(functions) <({ wrapped "$1"; exceptions; } | sort -u) | tr '\n' ' ')
    stale=$(comm -13 <(functions) <(exceptions | sort) | tr '\n' ' ')
    [ -z "$missing" ] || { echo "bare: no wrapper in src/ calls $missing"; return 1; }
    [ -z "$stale" ] || { echo "bare: listed in entries.sh, but core has no $stale"; return 1; }
}
