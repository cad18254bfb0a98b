//! Long lines of printed programs.

/// Breaks long lines at the commas inside their longest brackets.
pub(crate) fn wrapped(statement: &str) -> String {
    const LONGEST: usize = 108;
    let lines = statement.lines().map(|line| {
        let indent = line.len() - line.trim_start().len();
        if line.len() <= LONGEST || indent > 60 {
            return line.to_owned();
        }
        let Some((open, close, commas)) = brackets(line) else {
            return line.to_owned();
        };
        let deeper = " ".repeat(indent + 4);
        let mut text = line[..=open].to_owned();
        let mut start = open + 1;
        for end in commas.into_iter().map(|comma| comma + 1).chain([close]) {
            text.push_str(&format!(
                "\n{}",
                wrapped(&format!("{deeper}{}", line[start..end].trim()))
            ));
            start = end;
        }
        text + &format!("\n{}{}", " ".repeat(indent), &line[close..])
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the positions of the longest outermost pair of brackets and of the commas in it, ignoring texts
/// and comments.
fn brackets(line: &str) -> Option<(usize, usize, Vec<usize>)> {
    let mut longest: Option<(usize, usize, Vec<usize>)> = None;
    let (mut depth, mut open, mut commas) = (0, 0, Vec::new());
    let (mut quoted, mut comment, mut before) = (false, false, ' ');
    for (index, c) in line.char_indices() {
        match c {
            '"' if !comment && before != '\\' => quoted = !quoted,
            '*' if before == '/' && !quoted => comment = true,
            '/' if before == '*' => comment = false,
            _ if quoted || comment => {}
            '(' | '[' | '{' => {
                if depth == 0 {
                    (open, commas) = (index, Vec::new());
                }
                depth += 1;
            }
            ')' | ']' | '}' => {
                depth -= 1;
                let length = |(open, close, _): &(usize, usize, Vec<usize>)| close - open;
                if depth == 0 && longest.as_ref().is_none_or(|l| length(l) < index - open) {
                    longest = Some((open, index, std::mem::take(&mut commas)));
                }
            }
            ',' if depth == 1 => commas.push(index),
            _ => {}
        }
        before = c;
    }
    longest
}
