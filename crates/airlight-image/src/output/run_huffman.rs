//! Deflate (RFC 1951) of runs and Huffman codes only: for filtered pictures a few times as fast as a search for repeated strings, which
//! photographs and noise hardly contain.
//!
//! Each block has its own codes. Bytes are literals, except long runs of one byte, which become matches at distance 1.

use super::deflate::End;

/// Bytes of a block, which fit into a stored one.
const BLOCK: usize = 65_528;
/// Longest code, bits: four of them and a rest of 7 bits fit into 64.
const LONGEST: usize = 12;
/// Longest code of a code length, bits.
const LONGEST_OF_LENGTHS: usize = 7;
/// Literals, the end of the block and the lengths of matches.
const SYMBOLS: usize = 286;
const END_OF_BLOCK: usize = 256;
/// Longest match.
const LONGEST_MATCH: usize = 258;
/// Bytes compared together.
const STEP: usize = 8;

/// Compresses a piece of a stream, independently of those before it.
pub(super) fn compress(input: &[u8], end: End) -> Vec<u8> {
    let mut bits = BitWriter::new(input.len() + input.len() / 64 + 1024);
    let mut blocks = input.chunks(BLOCK).peekable();
    while let Some(block) = blocks.next() {
        let is_last = end == End::Last && blocks.peek().is_none();
        write_block(&mut bits, block, is_last);
    }
    if end == End::Open || input.is_empty() {
        // An empty stored block ends at a byte boundary.
        write_stored(&mut bits, &[], end == End::Last);
    }
    bits.finish()
}

fn write_block(bits: &mut BitWriter, block: &[u8], is_last: bool) {
    let counts = count_symbols(block);
    let lengths = code_lengths(&counts, LONGEST);
    let header = Header::new(&lengths);
    let coded: u64 = (counts.iter().zip(&lengths).enumerate())
        .map(|(symbol, (&count, &length))| {
            // A match has a code of one bit for its distance.
            let match_bits = match symbol > END_OF_BLOCK {
                true => 1 + EXTRA_BITS[symbol - END_OF_BLOCK - 1],
                false => 0,
            };
            u64::from(count) * u64::from(length + match_bits)
        })
        .sum();
    if coded + header.size_bits() >= 8 * block.len() as u64 {
        write_stored(bits, block, is_last);
        return;
    }
    bits.reserve(block.len() * 2 + 1024);
    bits.write(u32::from(is_last) | 2 << 1, 3);
    header.write(bits);
    let codes = Codes::new(&lengths);
    for_each_token(
        block,
        |bits, eight| bits.literals(&codes, eight),
        |bits, literal| bits.write_code(codes.of_symbol[usize::from(literal)]),
        |bits, length| {
            let (symbol, extra) = symbol_of_length(length);
            bits.write_code(codes.of_symbol[symbol]);
            // Then distance 1, whose code is 0.
            bits.write(extra, u32::from(EXTRA_BITS[symbol - END_OF_BLOCK - 1]) + 1);
        },
        bits,
    );
    bits.write_code(codes.of_symbol[END_OF_BLOCK]);
}

fn write_stored(bits: &mut BitWriter, block: &[u8], is_last: bool) {
    bits.reserve(block.len() + 16);
    bits.write(u32::from(is_last), 3);
    bits.align();
    let length = block.len() as u16;
    bits.bytes(&length.to_le_bytes());
    bits.bytes(&(!length).to_le_bytes());
    bits.bytes(block);
}

/// Splits a block into groups of eight literals, single literals and matches with the byte before them, by length.
#[inline(always)]
fn for_each_token<S>(
    block: &[u8],
    mut eight: impl FnMut(&mut S, &[u8; STEP]),
    mut literal: impl FnMut(&mut S, u8),
    mut matched: impl FnMut(&mut S, usize),
    state: &mut S,
) {
    let Some(&first) = block.first() else {
        return;
    };
    literal(state, first);
    let mut at = 1;
    while let Some(now) = block[at..].first_chunk::<STEP>() {
        let before = block[at - 1];
        if *now != [before; STEP] {
            eight(state, now);
            at += STEP;
            continue;
        }
        let run = block[at..].iter().take_while(|&&byte| byte == before);
        let run = run.count();
        at += run;
        let mut left = run;
        while left >= 3 {
            // No rest of one or two.
            let length = match left {
                0..=LONGEST_MATCH => left,
                259..=260 => left - 3,
                _ => LONGEST_MATCH,
            };
            matched(state, length);
            left -= length;
        }
    }
    for &byte in &block[at..] {
        literal(state, byte);
    }
}

fn count_symbols(block: &[u8]) -> [u32; SYMBOLS] {
    // Several tables, since equal bytes follow each other.
    let mut tables = [[0u32; SYMBOLS]; 4];
    for_each_token(
        block,
        |tables, eight| {
            for (i, &byte) in eight.iter().enumerate() {
                tables[i % 4][usize::from(byte)] += 1;
            }
        },
        |tables, byte| tables[0][usize::from(byte)] += 1,
        |tables, length| tables[0][symbol_of_length(length).0] += 1,
        &mut tables,
    );
    let mut counts = [0; SYMBOLS];
    for table in &tables {
        for (count, part) in counts.iter_mut().zip(table) {
            *count += part;
        }
    }
    counts[END_OF_BLOCK] = 1;
    counts
}

/// Shortest length of each match symbol (RFC 1951, section 3.2.5).
const SHORTEST: [u16; 29] = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131,
    163, 195, 227, 258,
];
/// Bits that follow each match symbol.
const EXTRA_BITS: [u8; 29] = [
    0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0,
];

/// Symbol of a match and the value of the bits that follow it.
fn symbol_of_length(length: usize) -> (usize, u32) {
    let length = length as u16;
    let index = SHORTEST.partition_point(|&shortest| shortest <= length) - 1;
    let extra = u32::from(length - SHORTEST[index]);
    (END_OF_BLOCK + 1 + index, extra)
}

/// Lengths of the codes of symbols that occur `counts` times: those of Huffman's codes, at most `longest`; 0 for symbols that do not
/// occur. At least two must.
fn code_lengths<const N: usize>(counts: &[u32; N], longest: usize) -> [u8; N] {
    let mut order: Vec<usize> = (0..N).filter(|&symbol| counts[symbol] > 0).collect();
    order.sort_by_key(|&symbol| counts[symbol]);
    let used = order.len();
    // Nodes of the tree: symbols in the order of their counts, then the pairs, whose counts rise as well.
    let mut weights: Vec<u64> = order.iter().map(|&s| u64::from(counts[s])).collect();
    let mut parents = vec![0; 2 * used - 1];
    let (mut leaf, mut pair) = (0, used);
    while weights.len() < 2 * used - 1 {
        let next = weights.len();
        let mut take = || {
            let is_leaf = leaf < used && (pair >= next || weights[leaf] <= weights[pair]);
            let node = if is_leaf { &mut leaf } else { &mut pair };
            *node += 1;
            *node - 1
        };
        let (a, b) = (take(), take());
        (parents[a], parents[b]) = (next, next);
        weights.push(weights[a] + weights[b]);
    }
    let mut depths = vec![0usize; 2 * used - 1];
    let mut of_length = vec![0usize; longest + 1];
    for node in (0..2 * used - 2).rev() {
        depths[node] = depths[parents[node]] + 1;
        if node < used {
            of_length[depths[node].min(longest)] += 1;
        }
    }
    // Shortened codes overfill the code space: lengthen one that has room below the limit for each step too many.
    let space = |of_length: &[usize]| -> usize {
        let parts = of_length.iter().enumerate().skip(1);
        parts.map(|(length, n)| n << (longest - length)).sum()
    };
    let mut too_many = space(&of_length) - (1 << longest);
    while too_many > 0 {
        let length = (1..longest).rev().find(|&length| of_length[length] > 0);
        let length = length.unwrap_or(1);
        // One code of this length becomes two that are longer by one, the second for a code of the greatest length.
        of_length[longest] -= 1;
        of_length[length] -= 1;
        of_length[length + 1] += 2;
        too_many -= 1;
    }
    let mut lengths = [0; N];
    let mut rarest_first = order.iter();
    for length in (1..=longest).rev() {
        for &symbol in rarest_first.by_ref().take(of_length[length]) {
            lengths[symbol] = length as u8;
        }
    }
    lengths
}

/// A code and its length: the code in the upper bits, the length in the lowest byte.
type Code = u32;

/// Codes of all symbols, lowest bit first as they are written.
struct Codes<const N: usize> {
    of_symbol: [Code; N],
}

impl<const N: usize> Codes<N> {
    /// Canonical codes (RFC 1951, section 3.2.2).
    fn new(lengths: &[u8; N]) -> Self {
        let mut next = [0u32; 17];
        let mut code = 0;
        for length in 1..=16u8 {
            next[usize::from(length)] = code;
            let count = lengths.iter().filter(|&&l| l == length).count() as u32;
            code = (code + count) << 1;
        }
        let of_symbol = lengths.map(|length| {
            if length == 0 {
                return 0;
            }
            let code = &mut next[usize::from(length)];
            let reversed = code.reverse_bits() >> (32 - u32::from(length));
            *code += 1;
            reversed << 8 | u32::from(length)
        });
        Self { of_symbol }
    }
}

/// The codes of a block as they are written before it (RFC 1951, section 3.2.7).
struct Header {
    /// Number of literal and length codes written.
    literals: usize,
    /// Symbols of the lengths, each with the value and number of the bits that follow.
    tokens: Vec<(usize, u32, u32)>,
    lengths: [u8; 19],
    /// Number of the lengths of the codes above that are written.
    count: usize,
}

/// Order in which the lengths of the codes of lengths are written.
const ORDER: [usize; 19] = [
    16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
];

impl Header {
    fn new(lengths: &[u8; SYMBOLS]) -> Self {
        let literals = 1 + lengths.iter().rposition(|&l| l > 0).unwrap_or(END_OF_BLOCK);
        // Two distances of one bit each: some decoders refuse a single one.
        let all: Vec<u8> = lengths[..literals].iter().copied().chain([1, 1]).collect();
        let mut tokens = Vec::new();
        for run in all.chunk_by(|a, b| a == b) {
            let value = usize::from(run[0]);
            let mut left = run.len();
            if value > 0 {
                tokens.push((value, 0, 0));
                left -= 1;
            }
            while left > 0 {
                let (token, taken) = match (value, left) {
                    (0, 11..) => ((18, left.min(138) as u32 - 11, 7), left.min(138)),
                    (0, 3..) => ((17, left as u32 - 3, 3), left),
                    (_, 3..) => ((16, left.min(6) as u32 - 3, 2), left.min(6)),
                    _ => ((value, 0, 0), 1),
                };
                tokens.push(token);
                left -= taken;
            }
        }
        let mut counts = [0; 19];
        for &(symbol, ..) in &tokens {
            counts[symbol] += 1;
        }
        let lengths = code_lengths(&counts, LONGEST_OF_LENGTHS);
        let last = ORDER.iter().rposition(|&symbol| lengths[symbol] > 0);
        Self {
            literals,
            tokens,
            lengths,
            count: last.map_or(4, |last| (last + 1).max(4)),
        }
    }

    fn size_bits(&self) -> u64 {
        let tokens = self.tokens.iter();
        let tokens =
            tokens.map(|&(symbol, _, extra)| u64::from(self.lengths[symbol]) + u64::from(extra));
        3 + 14 + 3 * self.count as u64 + tokens.sum::<u64>()
    }

    fn write(&self, bits: &mut BitWriter) {
        bits.write(self.literals as u32 - 257, 5);
        bits.write(1, 5);
        bits.write(self.count as u32 - 4, 4);
        for &symbol in &ORDER[..self.count] {
            bits.write(u32::from(self.lengths[symbol]), 3);
        }
        let codes = Codes::new(&self.lengths);
        for &(symbol, value, count) in &self.tokens {
            bits.write_code(codes.of_symbol[symbol]);
            bits.write(value, count);
        }
    }
}

/// Bits, lowest first.
struct BitWriter {
    /// Written bytes up to `at`, then room.
    bytes: Vec<u8>,
    at: usize,
    buffer: u64,
    /// Number of bits in the buffer, fewer than 8 between calls.
    count: u32,
}

impl BitWriter {
    fn new(room: usize) -> Self {
        Self {
            bytes: vec![0; room],
            at: 0,
            buffer: 0,
            count: 0,
        }
    }

    /// Makes room for a number of bytes.
    fn reserve(&mut self, count: usize) {
        let needed = self.at + count + 8;
        if self.bytes.len() < needed {
            self.bytes.resize(needed.max(self.bytes.len() * 3 / 2), 0);
        }
    }

    /// Moves whole bytes of the buffer to the output.
    #[inline(always)]
    fn flush(&mut self) {
        self.bytes[self.at..][..8].copy_from_slice(&self.buffer.to_le_bytes());
        let whole = self.count / 8;
        self.at += whole as usize;
        self.buffer >>= 8 * whole;
        self.count %= 8;
    }

    #[inline(always)]
    fn push(&mut self, value: u32, count: u32) {
        self.buffer |= u64::from(value) << self.count;
        self.count += count;
    }

    /// Writes up to 32 bits.
    fn write(&mut self, value: u32, count: u32) {
        self.push(value, count);
        self.flush();
    }

    fn write_code(&mut self, code: Code) {
        self.write(code >> 8, code & 0xff);
    }

    #[inline(always)]
    fn literals<const N: usize>(&mut self, codes: &Codes<N>, eight: &[u8; STEP]) {
        for four in eight.as_chunks::<4>().0 {
            for &byte in four {
                let code = codes.of_symbol[usize::from(byte)];
                self.push(code >> 8, code & 0xff);
            }
            self.flush();
        }
    }

    fn align(&mut self) {
        self.count = self.count.next_multiple_of(8);
        self.flush();
    }

    /// Writes whole bytes at a byte boundary.
    fn bytes(&mut self, bytes: &[u8]) {
        self.reserve(bytes.len());
        self.bytes[self.at..][..bytes.len()].copy_from_slice(bytes);
        self.at += bytes.len();
    }

    fn finish(mut self) -> Vec<u8> {
        self.align();
        self.bytes.truncate(self.at);
        self.bytes
    }
}
