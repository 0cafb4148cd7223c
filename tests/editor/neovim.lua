-- SPDX-License-Identifier: MIT
-- Run in a headless Neovim whose first buffer is a scene: does what somebody does who edits it, and prints what came
-- of it as one line of JSON. Requests are those that Neovim's own commands make; waits have no end but what must come.
local got = {}

local function until_true(what, holds)
  if not vim.wait(120000, holds, 10) then
    print("\n" .. what .. " does not come")
    vim.cmd("cquit!")
  end
end

local function ask(method, more)
  local params = vim.lsp.util.make_position_params(0, "utf-16")
  for key, value in pairs(more or {}) do params[key] = value end
  for _, answer in pairs(vim.lsp.buf_request_sync(0, method, params, 120000) or {}) do
    if answer.result then return answer.result, params end
  end
end

local function lines() return vim.api.nvim_buf_get_lines(0, 0, -1, true) end

local function finding()
  local found = vim.diagnostic.get(0)[1]
  return found and { found.lnum, found.col, found.message }
end

local function work()
  until_true("a finding", function() return #vim.diagnostic.get(0) > 0 end)
  got.finding = finding()
  vim.api.nvim_buf_set_text(0, 1, 3, 1, 3, { "e" })
  until_true("the end of the finding", function() return #vim.diagnostic.get(0) == 0 end)

  vim.api.nvim_win_set_cursor(0, { 3, 1 })
  got.hover = ask("textDocument/hover").contents.value
  local file = vim.fn.expand("%:t")
  vim.lsp.buf.definition()
  until_true("the definition", function() return vim.fn.expand("%:t") ~= file end)
  got.definition = { vim.fn.expand("%:t"), vim.api.nvim_win_get_cursor(0)[1] }
  vim.cmd("buffer 1")

  vim.api.nvim_buf_set_lines(0, 3, 4, true, { "translate([1,2,3])  whee" })
  vim.api.nvim_win_set_cursor(0, { 4, 24 })
  got.completion = {}
  for _, item in ipairs(ask("textDocument/completion").items) do
    table.insert(got.completion, item.label)
  end
  vim.api.nvim_buf_set_text(0, 3, 24, 3, 24, { "l(r = 1);" })

  vim.api.nvim_win_set_cursor(0, { 3, 1 })
  local edit = ask("textDocument/rename", { newName = "disc" })
  vim.lsp.util.apply_workspace_edit(edit, "utf-16")
  local layout = ask("textDocument/formatting", { options = { tabSize = 2, insertSpaces = true } })
  vim.lsp.util.apply_text_edits(layout, vim.api.nvim_get_current_buf(), "utf-16")
  got.text = lines()
end

local done, problem = pcall(work)
print("\n" .. (done and vim.fn.json_encode(got) or problem))
vim.cmd(done and "qall!" or "cquit!")
