#!/usr/bin/awk -f
# From lcov's records to the tables of COVERAGE.md: by file lines and branches that tests run, and which lines they do not.
/^SF:/ {
    file = substr($0, 4)
    kept = sub(/^.*\/core\/src\//, "", file)
    missed = ""
    lines = hit = branches = taken = 0
}
/^DA:/ && kept {
    split(substr($0, 4), part, ",")
    lines++
    if (part[2] > 0) hit++
    else if (part[1] == last + 1 && missed != "") { sub(/(–[0-9]+)?$/, "–" part[1], missed); last = part[1] }
    else { missed = missed (missed == "" ? "" : ", ") part[1]; last = part[1] }
}
/^BRDA:/ && kept {
    split(substr($0, 6), part, ",")
    branches++
    if (part[4] != "-" && part[4] > 0) taken++
}
/^end_of_record/ && kept {
    row[++n] = file
    of[file] = sprintf("| `%s` | %d | %s | %s | %s | %s |", file, lines, share(hit, lines), branches ? branches : "", share(taken, branches), missed)
    all_lines += lines; all_hit += hit; all_branches += branches; all_taken += taken
}
function share(part, whole) { return whole ? sprintf("%.1f", 100 * part / whole) : "" }
END {
    printf "Lines run: **%s %%** of %d. Branches taken: **%s %%** of %d.\n\n", share(all_hit, all_lines), all_lines, share(all_taken, all_branches), all_branches
    print "| file | lines | run, % | branches | taken, % | lines that no test runs |"
    print "| --- | --: | --: | --: | --: | --- |"
    for (i = 1; i <= n; i++) print of[row[i]]
}
