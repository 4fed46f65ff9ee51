# Every public function of the Rust files given, as Type::name, trait::name or module::name: the `pub fn`s, and the
# functions of public traits. Of an impl block only the type's own name counts.

# The first identifier after a leading <...> list.
function named(text,    depth, i, c) {
    if (substr(text, 1, 1) == "<") {
        for (i = 1; i <= length(text); i++) {
            c = substr(text, i, 1)
            if (c == "<") depth++
            if (c == ">" && substr(text, i - 1, 1) != "-" && --depth == 0) break
        }
        text = substr(text, i + 1)
    }
    sub(/^ +/, "", text)
    sub(/[^A-Za-z0-9_].*/, "", text)
    return text
}

FNR == 1 {
    module = FILENAME
    sub(/.*\//, "", module)
    sub(/\.rs$/, "", module)
    owner = module
    trait = 0
}
/^impl/ { owner = named(substr($0, 5)); trait = 0 }
/^pub trait / { owner = named(substr($0, 11)); trait = 1 }
/^}/ { owner = module; trait = 0 }
trait && /^    (const )?fn / || /^ *pub (const )?fn / {
    name = $0
    sub(/.*fn /, "", name)
    sub(/[^A-Za-z0-9_].*/, "", name)
    print owner "::" name
}
