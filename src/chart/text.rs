//! Text and numbers as markup: escaped, short, and bytes as base64.

/// Longest text from a file that is shown whole \[characters\].
pub const LONGEST: usize = 400;

/// Text as HTML, inside elements and inside quoted attributes: nothing in it is markup, and long text is cut.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len().min(2 * LONGEST));
    for (count, c) in text.chars().enumerate() {
        if count == LONGEST {
            out.push('…');
            break;
        }
        push_escaped(&mut out, c);
    }
    out
}

/// The same of a text of any length, for blocks that scroll.
pub fn escape_whole(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    text.chars().for_each(|c| push_escaped(&mut out, c));
    out
}

fn push_escaped(out: &mut String, c: char) {
    match c {
        '&' => out.push_str("&amp;"),
        '<' => out.push_str("&lt;"),
        '>' => out.push_str("&gt;"),
        '"' => out.push_str("&quot;"),
        '\'' => out.push_str("&#39;"),
        '\n' | '\t' => out.push(c),
        // Control characters, and marks that turn the direction of what follows.
        c if c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c) || ('\u{2066}'..='\u{2069}').contains(&c) => {
            out.push('\u{fffd}')
        }
        c => out.push(c),
    }
}

/// Standard base64 with padding (RFC 4648).
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(base64_length(bytes.len() as u64) as usize);
    for chunk in bytes.chunks(3) {
        let word = chunk
            .iter()
            .enumerate()
            .fold(0u32, |word, (i, &b)| word | u32::from(b) << (16 - 8 * i));
        for digit in 0..4 {
            let value = word >> (18 - 6 * digit) & 63;
            out.push(if digit <= chunk.len() {
                DIGITS[value as usize] as char
            } else {
                '='
            });
        }
    }
    out
}

/// Length of so many bytes in base64 \[bytes\].
pub fn base64_length(bytes: u64) -> u64 {
    bytes.div_ceil(3).saturating_mul(4)
}

/// A number in a few digits.
pub fn number(x: f64) -> String {
    let size = x.abs();
    match x {
        _ if x.is_nan() => "NaN".to_owned(),
        _ if x.is_infinite() => if x > 0.0 { "∞" } else { "-∞" }.to_owned(),
        0.0 => "0".to_owned(),
        _ if size < 1e7 && x.fract() == 0.0 => thousands(x as i64),
        _ if (1000.0..1e7).contains(&size) => thousands(x.round() as i64),
        _ if (100.0..1000.0).contains(&size) => format!("{x:.0}"),
        _ if (10.0..100.0).contains(&size) => format!("{x:.1}"),
        _ if (1.0..10.0).contains(&size) => format!("{x:.2}"),
        _ if (0.01..1.0).contains(&size) => format!("{x:.3}"),
        _ => format!("{x:.2e}"),
    }
}

/// A count with commas between thousands.
pub fn thousands(n: i64) -> String {
    let digits = n.unsigned_abs().to_string();
    let mut out = if n < 0 { "-".to_owned() } else { String::new() };
    for (i, d) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(d);
    }
    out
}
